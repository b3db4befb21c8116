// SPDX-License-Identifier: Apache-2.0
// The pool of devices that make a picture, which drops devices that fail.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "host/samplers/sampler_stages.h"
#include "host/session/band_renderer.h"
#include "host/session/band_sharing.h"
#include "host/stages/first_surfaces.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// A device with the stages and the scene that a picture needs. Construction begins to compile the stages.
struct PoolDevice {
    PoolDevice(Device& device, GatherKernel kernel) : bands(device, kernel) {}

    [[nodiscard]] Device& device() const { return bands.device; }

    BandStages bands;
    DeviceScene scene{};
    std::optional<SamplerStages> samplers{};        ///< only the leader has them
    std::optional<FirstSurfaces> first_surfaces{};  ///< made when mattes are first asked for
};

/// The devices that have not failed, at least one. The first device leads: views and VPLs are made on it. A
/// device that fails is dropped with a warning, and the next one leads if it was the leader. If the last
/// device fails, its error is thrown.
class DevicePool {
  public:
    /// Keeps references to `devices`, one or more, which must outlive the pool.
    DevicePool(std::span<Device* const> devices, GatherKernel kernel);

    [[nodiscard]] std::size_t size() const { return devices_.size(); }
    /// The number of devices whose memory is the machine's own.
    [[nodiscard]] std::size_t cpu_count() const;
    [[nodiscard]] std::span<const std::unique_ptr<PoolDevice>> devices() const { return devices_; }
    [[nodiscard]] PoolDevice& leader() const { return *devices_.front(); }

    /// The shapes of trees that the devices need, all devices together.
    [[nodiscard]] TreeShapes tree_shapes() const;
    /// Uploads the scene to every device. The trees must have the shapes of tree_shapes().
    void upload(const Scene& scene, const ShapedBvh& tree);

    /// Calls work(leader), and again with the next leader if it throws an Error. One of the kind
    /// ErrorKind::invalid_argument is passed on, because no device is to blame for it.
    template <typename Work>
    std::invoke_result_t<Work, PoolDevice&> on_leader(const Work& work) {
        for (;;) {
            try {
                appoint_leader();
                return work(leader());
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::invalid_argument) {
                    throw;
                }
                lose(0, error);
            }
        }
    }

    /// Drops the devices whose share says that they failed, but keeps the last one, so that the pool is never
    /// empty. If there is more to do, that device's own error ends it. `shares` are in the order of
    /// devices().
    void drop_failed(std::span<const BandShare> shares);

    /// The sum of the devices' peak allocations, in bytes.
    [[nodiscard]] std::size_t peak_bytes() const;

  private:
    void lose(std::size_t index, const Error& error);
    void drop(std::size_t index);
    void appoint_leader();

    GatherKernel kernel_;
    std::vector<std::unique_ptr<PoolDevice>> devices_;
};

}  // namespace nearlight::core
