// SPDX-License-Identifier: Apache-2.0
// Local lights of each packet of receivers, which supply what VPLs lose to a wide clamp radius. The kernels
// are in local_lights.cl.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// What local lights are to supply, and how. A VPL at y is gathered with the radius R_g(y) = max_radius /
/// 2^level, but never below the clamp radius. The level is the first of 0 to 3 for which the radius is at
/// most radius_at_unit_light / √E(y), where E estimates the direct light (luminance, W/m²). Local lights
/// supply the rest, down to the clamp radius.
struct LocalLightPlan {
    float clamp_radius = 0.0f;  ///< m
    float max_radius = 0.0f;    ///< m, at least clamp_radius; local lights lie within it
    /// Narrows the radius of well-lit VPLs, in m·√(W/m²); infinity makes every radius max_radius.
    float radius_at_unit_light = std::numeric_limits<float>::infinity();
    uint rays_per_receiver = 1;  ///< short rays that find local lights
    uint connections = 1;        ///< from each local light to VPLs, chosen with equal probability
    uint direct_samples = 1;     ///< towards area and environment lights, from each local light
    uint bounce_count = 1;       ///< maximum number of edges of a path from an emitter to a local light
    uint seed = 0;
};

/// VPLs of all depths, in an order in which neighbours are alike, and the radius that each is gathered with.
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
    std::vector<Group> groups;  ///< the same VPLs by radius, the widest first; each takes one gather
};

/// Slots for local lights: rays_per_receiver · 64 per packet, in the order that kernels/local_lights.cl
/// states.
struct LocalLightSlots {
    LocalLightSlots(Device& device, std::size_t slot_count)
        : lights(device, slot_count),
          radii(device, slot_count),
          flags(device, slot_count),
          indices(device, slot_count),
          seen_by(device, slot_count) {}

    Buffer<Vpl> lights;             ///< power is exitance (W/m²) over the density of lights (1/m²): flux, W
    Buffer<float> radii;            ///< R_g of each light, m
    Buffer<uint> flags;             ///< 1 where the slot holds a light
    Buffer<uint> indices;           ///< slots that hold a light, ascending
    Buffer<std::uint64_t> seen_by;  ///< for each light: bit i is 1 if receiver i of the packet sees it
};

class LocalLights {
  public:
    explicit LocalLights(Device& device);

    /// Chooses the radius of each VPL and groups the VPLs by it.
    LocalVpls group(const DeviceScene& scene, std::span<const Vpl> vpls, const LocalLightPlan& plan);

    /// Adds an unbiased estimate of the missing light to the irradiance of each receiver: the light with the
    /// geometry term bounded at the clamp radius, less the light with the term bounded at R_g. `vpls` are the
    /// VPLs of the gather. Returns the number of local lights.
    std::size_t add(const DeviceScene& scene, const LocalVpls& vpls, const Buffer<ReceiverPacket>& receivers,
                    std::size_t packet_count, const LocalLightPlan& plan,
                    Buffer<IrradiancePacket>& irradiance);

    /// Makes the local lights of the packets [first_packet, first_packet + packet_count), which is the first
    /// part of add(). Returns their number.
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
