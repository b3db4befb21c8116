// SPDX-License-Identifier: Apache-2.0
// Device memory that knows its element type.
#pragma once

#include <CL/opencl.hpp>
#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/cl/device.h"
#include "host/cl/huge_pages.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {

/// `count` elements of T in device memory. Large buffers of CPU devices are in huge pages. An empty buffer
/// takes memory too, so that it can be given to a kernel, which must not access it. Uploads and downloads
/// wait until they are done, and the in-order queue puts them in sequence with kernels. A buffer may be
/// destroyed while kernels that use it still wait to run: OpenCL keeps the memory for commands in a queue
/// (OpenCL 1.2, clReleaseMemObject), though the device no longer counts it.
template <typename T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Buffer() = default;
    Buffer(Device& device, std::size_t count) : device_(&device), count_(count) {
        const std::size_t limit = device.entry().max_allocation_bytes;
        if (count > limit / sizeof(T)) {
            throw Error(ErrorKind::out_of_memory,
                        "a buffer of " + std::to_string(count) + " × " + std::to_string(sizeof(T)) +
                            " bytes exceeds the largest allocation of device " + device.name() + " (" +
                            std::to_string(limit >> 20) + " MiB)");
        }
        handle_ = with_opencl_errors(std::to_string(bytes() >> 20) + " MiB on device " + device.name(), [&] {
            const bool huge = device.is_cpu() && bytes() >= kMinHugeBytes;
            const cl::Buffer buffer = huge ? make_huge_buffer(device.context(), bytes()) : cl::Buffer();
            return buffer() != nullptr ? buffer : cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes());
        });
        device.add_allocated(bytes());
    }
    Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) { upload(values); }
    ~Buffer() { release(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        if (this != &other) {
            release();
            device_ = std::exchange(other.device_, nullptr);
            count_ = std::exchange(other.count_, 0);
            handle_ = std::exchange(other.handle_, cl::Buffer());
        }
        return *this;
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const cl::Buffer& handle() const { return handle_; }

    void upload(std::span<const T> values, std::size_t first = 0) {
        if (!values.empty()) {
            with_opencl_errors("device " + device_->name(), [&] {
                device_->queue().enqueueWriteBuffer(handle_, CL_TRUE, first * sizeof(T), values.size_bytes(),
                                                    values.data());
            });
        }
    }
    void download(std::span<T> values, std::size_t first = 0) const {
        if (!values.empty()) {
            with_opencl_errors("device " + device_->name(), [&] {
                device_->queue().enqueueReadBuffer(handle_, CL_TRUE, first * sizeof(T), values.size_bytes(),
                                                   values.data());
            });
        }
    }
    [[nodiscard]] std::vector<T> download() const {
        std::vector<T> values(count_);
        download(values);
        return values;
    }
    [[nodiscard]] T download_one(std::size_t index) const {
        T value;
        download(std::span(&value, 1), index);
        return value;
    }
    void fill_zero() {
        with_opencl_errors("device " + device_->name(),
                           [&] { device_->queue().enqueueFillBuffer(handle_, cl_uchar{0}, 0, bytes()); });
    }

  private:
    [[nodiscard]] std::size_t bytes() const { return std::max<std::size_t>(count_, 1) * sizeof(T); }
    void release() {
        if (device_ != nullptr) {
            device_->remove_allocated(bytes());
            device_ = nullptr;
        }
    }

    Device* device_ = nullptr;
    std::size_t count_ = 0;
    cl::Buffer handle_;
};

/// Replaces the buffer by one of `count` elements if it has fewer or was never made. What was in it is lost.
template <typename T>
void ensure_room(Buffer<T>& buffer, Device& device, std::size_t count) {
    if (buffer.count() < count || buffer.handle()() == nullptr) {
        buffer = Buffer<T>(device, count);
    }
}

}  // namespace nearlight::core
