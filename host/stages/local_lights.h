// SPDX-License-Identifier: Apache-2.0
// Lights of each packet of receivers, which supply what VPLs lose to a wide clamp. Kernels: local_lights.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"

namespace nearlight {

/// What local lights are to supply, and how.
struct LocalLightPlan {
    float gather_radius = 0.0f;  ///< R_g, that of the VPLs' gather; local lights lie within it, m
    uint rays_per_receiver = 1;  ///< that look for lights
    uint connections = 1;        ///< from each light to VPLs, chosen evenly among them
    uint direct_samples = 1;     ///< towards area and environment lights, from each light
    uint bounce_count = 1;       ///< most steps that light takes to a local light
    uint seed = 0;
};

/// rays_per_receiver · 64 slots a packet; kernels/local_lights.cl says which is whose.
struct LocalLightSlots {
    LocalLightSlots(Device& device, std::size_t slot_count)
        : lights(device, slot_count),
          flags(device, slot_count),
          indices(device, slot_count),
          seen_by(device, slot_count) {}

    Buffer<Vpl> lights;             ///< power is exitance (W/m²) over the density of lights (1/m²): flux, W
    Buffer<uint> flags;             ///< 1 where the slot holds a light
    Buffer<uint> indices;           ///< of those slots, ascending
    Buffer<std::uint64_t> seen_by;  ///< of a light: bit i stands for receiver i of the packet
};

class LocalLights {
  public:
    explicit LocalLights(Device& device);

    /// Adds to the irradiance of each receiver what the geometry term bounded at `clamp_radius` has and that
    /// bounded at plan.gather_radius has not, as an unbiased estimate. `vpls` are those of the gather, of
    /// all depths, in an order in which neighbours are alike. Returns how many local lights there were.
    std::size_t add(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                    const Buffer<ReceiverPacket>& receivers, std::size_t packet_count, float clamp_radius,
                    const LocalLightPlan& plan, Buffer<IrradiancePacket>& irradiance);

    /// Its first part: the lights of the packets [first_packet, first_packet + packet_count). Returns their
    /// number.
    std::size_t make(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                     const Buffer<ReceiverPacket>& receivers, std::size_t first_packet,
                     std::size_t packet_count, const LocalLightPlan& plan, LocalLightSlots& slots);

  private:
    Device* device_;
    Program program_;
    Kernel rays_;
    Kernel density_;
    Kernel gather_;
    Compaction compaction_;
};

}  // namespace nearlight
