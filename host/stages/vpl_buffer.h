// SPDX-License-Identifier: Apache-2.0
// A set of VPLs in device memory.
#pragma once

#include <span>
#include <vector>

#include "host/cl/buffer.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// VPLs in the memory of one device. They can be downloaded where the host needs them.
class VplBuffer {
  public:
    VplBuffer() = default;
    /// Takes the first `count` VPLs of `buffer`, which is on `device`.
    VplBuffer(Device& device, Buffer<Vpl> buffer, std::size_t count)
        : device_(&device), buffer_(std::move(buffer)), count_(count) {}
    /// Uploads `vpls` to `device`.
    VplBuffer(Device& device, std::span<const Vpl> vpls)
        : VplBuffer(device, Buffer<Vpl>(device, vpls), vpls.size()) {}
    /// VPLs that are on no device yet, for copy_to().
    explicit VplBuffer(std::vector<Vpl> on_host) : count_(on_host.size()), on_host_(std::move(on_host)) {}

    [[nodiscard]] const Buffer<Vpl>& buffer() const { return buffer_; }
    [[nodiscard]] Buffer<Vpl>& buffer() { return buffer_; }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] bool is_on(const Device& device) const { return device_ == &device; }

    /// The VPLs, from the copy on the host if there is one.
    [[nodiscard]] std::vector<Vpl> download() const {
        if (on_host_.size() == count_) {
            return on_host_;
        }
        std::vector<Vpl> vpls(count_);
        buffer_.download(vpls);
        return vpls;
    }

    /// Keeps a copy of the VPLs on the host, so that download() and copy_to() work after the device has
    /// failed and from several threads.
    void keep_on_host() { on_host_ = download(); }
    /// The copy on the host; empty if none is kept there.
    [[nodiscard]] std::span<const Vpl> on_host() const { return on_host_; }
    /// Uploads the same VPLs to `device`.
    [[nodiscard]] VplBuffer copy_to(Device& device) const { return {device, download()}; }

  private:
    Device* device_ = nullptr;
    Buffer<Vpl> buffer_;
    std::size_t count_ = 0;
    std::vector<Vpl> on_host_;  ///< all VPLs, or none if no copy is kept
};

}  // namespace nearlight::core
