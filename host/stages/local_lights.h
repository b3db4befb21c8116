// SPDX-License-Identifier: Apache-2.0
// Lights of each packet of receivers, which supply what VPLs lose to a wide clamp. Kernels: local_lights.cl.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// What local lights are to supply, and how. VPLs at y are gathered with the radius R_g(y) = widest_radius /
/// 2^level, level the first of 0 to 3 for which that is at most radius_at_unit_light / √E(y), and not below
/// the clamp radius; E is an estimate of the direct light (W/m², luminance). Local lights supply the rest,
/// down to the clamp radius.
struct LocalLightPlan {
    float clamp_radius = 0.0f;   ///< m
    float widest_radius = 0.0f;  ///< m, at least clamp_radius; local lights lie within it
    float radius_at_unit_light =
        std::numeric_limits<float>::infinity();  ///< m·√(W/m²); infinite: all the widest
    uint rays_per_receiver = 1;                  ///< that look for lights
    uint connections = 1;                        ///< from each light to VPLs, chosen evenly among them
    uint direct_samples = 1;                     ///< towards area and environment lights, from each light
    uint bounce_count = 1;                       ///< most steps that light takes to a local light
    uint seed = 0;
};

/// VPLs of all depths, in an order in which neighbours are alike, and the radius that belongs to each.
struct LocalVpls {
    explicit LocalVpls(Device& device) : radii(device, 0), vpls(device, 0) {}

    struct Group {
        float radius = 0.0f;  ///< m
        Buffer<Vpl> vpls;
        std::size_t count = 0;
    };
    std::size_t count = 0;
    Buffer<float> radii;  ///< m
    Buffer<Vpl> vpls;
    std::vector<Group> groups;  ///< the same VPLs by radius, for as many gathers; the widest radius first
};

/// rays_per_receiver · 64 slots a packet; kernels/local_lights.cl says which is whose.
struct LocalLightSlots {
    LocalLightSlots(Device& device, std::size_t slot_count)
        : lights(device, slot_count),
          radii(device, slot_count),
          flags(device, slot_count),
          indices(device, slot_count),
          seen_by(device, slot_count) {}

    Buffer<Vpl> lights;             ///< power is exitance (W/m²) over the density of lights (1/m²): flux, W
    Buffer<float> radii;            ///< R_g of a light, m
    Buffer<uint> flags;             ///< 1 where the slot holds a light
    Buffer<uint> indices;           ///< of those slots, ascending
    Buffer<std::uint64_t> seen_by;  ///< of a light: bit i stands for receiver i of the packet
};

class LocalLights {
  public:
    explicit LocalLights(Device& device);

    /// Decides on the radius of each VPL.
    LocalVpls group(const DeviceScene& scene, std::span<const Vpl> vpls, const LocalLightPlan& plan);

    /// Adds to the irradiance of each receiver what the geometry term bounded at the clamp radius has and
    /// that bounded at R_g has not, as an unbiased estimate. `vpls` are those of the gather. Returns how many
    /// local lights there were.
    std::size_t add(const DeviceScene& scene, const LocalVpls& vpls, const Buffer<ReceiverPacket>& receivers,
                    std::size_t packet_count, const LocalLightPlan& plan,
                    Buffer<IrradiancePacket>& irradiance);

    /// Its first part: the lights of the packets [first_packet, first_packet + packet_count). Returns their
    /// number.
    std::size_t make(const DeviceScene& scene, const LocalVpls& vpls, const Buffer<ReceiverPacket>& receivers,
                     std::size_t first_packet, std::size_t packet_count, const LocalLightPlan& plan,
                     LocalLightSlots& slots);

  private:
    Device* device_;
    Program program_;
    Kernel radii_;
    Kernel rays_;
    Kernel density_;
    Kernel gather_;
    Compaction compaction_;
};

}  // namespace nearlight::core
