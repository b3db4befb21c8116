// SPDX-License-Identifier: Apache-2.0
// The devices that make a picture, and what becomes of those that fail.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "host/samplers/sampler_stages.h"
#include "host/session/band_renderer.h"
#include "host/session/band_sharing.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// A device with what a picture needs on it; stages compile from construction on.
struct PoolDevice {
    PoolDevice(Device& device, GatherKernel kernel) : bands(device, kernel) {}

    [[nodiscard]] Device& device() const { return bands.device; }

    BandStages bands;
    DeviceScene scene{};
    std::optional<SamplerStages> samplers{};  ///< of the leader only
};

/// Devices that have not failed, one at least. The first leads: views and VPLs are made on it. A device that
/// fails is dropped with a warning, and the next one leads; the last one's error is thrown.
class DevicePool {
  public:
    /// Refers to `devices`, one or more, which must outlive it.
    DevicePool(std::span<Device* const> devices, GatherKernel kernel);

    [[nodiscard]] std::size_t size() const { return devices_.size(); }
    [[nodiscard]] std::span<const std::unique_ptr<PoolDevice>> devices() const { return devices_; }
    [[nodiscard]] PoolDevice& leader() const { return *devices_.front(); }
    /// The same without stages, for what only asks what a device is like.
    [[nodiscard]] std::vector<const Device*> plain_devices() const;

    /// The shapes of trees that any of the devices goes through.
    [[nodiscard]] TreeShapes tree_shapes() const;
    /// To every device; the trees must have tree_shapes().
    void upload(const Scene& scene, const SceneTrees& trees);

    /// work(leader), again on the next leader where it throws an Error.
    template <typename Work>
    std::invoke_result_t<Work, PoolDevice&> on_leader(const Work& work) {
        for (;;) {
            try {
                return work(leader());
            } catch (const Error& error) {
                lose(0, error);
            }
        }
    }

    /// Drops those whose share says that they failed. `shares` are of devices(), in their order.
    void drop_failed(std::span<const BandShare> shares);

    /// The sum of what each had allocated at most, in bytes.
    [[nodiscard]] std::size_t peak_bytes() const;

  private:
    void lose(std::size_t index, const Error& error);
    void drop(std::size_t index);
    void appoint_leader();

    GatherKernel kernel_;
    std::vector<std::unique_ptr<PoolDevice>> devices_;
};

}  // namespace nearlight::core
