// SPDX-License-Identifier: Apache-2.0
// The gather of the sampler `local`: VPLs with wide clamp radii, and local lights for what those take away.
#pragma once

#include "host/stages/gatherer.h"
#include "host/stages/local_lights.h"
#include "host/stages/vpl_buffer.h"
#include "host/stages/vpl_light.h"

namespace nearlight::core {

class LocalGather {
  public:
    /// Begins to compile the kernels, and does not wait for the compiler.
    explicit LocalGather(Device& device)
        : device_(&device), lights_(device), vpl_light_(device), vpls_(device) {}

    /// Sets the VPLs of a picture, which must be of all depths and in Morton order.
    void set_vpls(const DeviceScene& scene, const VplBuffer& vpls, const LocalLightPlan& plan);

    /// Writes the irradiance of the receivers in the first packet_count packets to sums.light. Bundles ask
    /// about their strata of the VPLs of each radius. Returns false if cancelled.
    bool run(Gatherer& gatherer, const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
             std::size_t packet_count, const VplStrata& strata, GatherSums<Vpl>& sums,
             const GatherProgress& progress);

    /// The number of local lights that were made since set_vpls().
    [[nodiscard]] std::size_t light_count() const { return light_count_; }

  private:
    Device* device_;
    LocalLights lights_;
    VplLight vpl_light_;
    LocalVpls vpls_;
    LocalLightPlan plan_;
    std::size_t light_count_ = 0;
};

}  // namespace nearlight::core
