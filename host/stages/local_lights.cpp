// SPDX-License-Identifier: Apache-2.0
#include "host/stages/local_lights.h"

#include <algorithm>
#include <functional>
#include <map>

#include "kernels/shared/local_lights.h"

namespace nearlight::core {
namespace {

/// The number of slots that are worked on at a time. It keeps the device busy and takes at most a few dozen
/// MiB.
std::size_t slots_at_a_time(const Device& device) {
    const std::size_t wanted = device.tunables().batch_receivers / 2;
    return std::min(wanted, device.entry().max_allocation_bytes / (2 * sizeof(Vpl)));
}

GatherRadius law_of(const LocalLightPlan& plan) {
    return {.max_radius = plan.max_radius,
            .min_radius = plan.clamp_radius,
            .at_unit_light = plan.radius_at_unit_light,
            .seed = plan.seed};
}

}  // namespace

LocalLights::LocalLights(Device& device)
    : device_(&device),
      program_(device, "local_lights.cl"),
      radii_(program_, "local_light_radii"),
      rays_(program_, "local_light_rays"),
      density_(program_, "local_light_density"),
      gather_(program_, "local_light_gather"),
      compaction_(device) {}

LocalVpls LocalLights::group(const DeviceScene& scene, std::span<const Vpl> vpls,
                             const LocalLightPlan& plan) {
    LocalVpls result(*device_);
    result.count = vpls.size();
    result.vpls = Buffer<Vpl>(*device_, vpls);
    result.radii = Buffer<float>(*device_, vpls.size());
    radii_.launch_items(vpls.size(), scene, result.vpls, static_cast<uint>(vpls.size()), law_of(plan),
                        result.radii);
    const std::vector<float> radii = result.radii.download();
    std::map<float, std::vector<Vpl>, std::greater<>> by_radius;
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        by_radius[radii[i]].push_back(vpls[i]);
    }
    for (const auto& [radius, members] : by_radius) {
        result.groups.push_back({.radius = radius,
                                 .vpls = Buffer<Vpl>(*device_, std::span<const Vpl>(members)),
                                 .count = members.size()});
    }
    return result;
}

std::size_t LocalLights::make(const DeviceScene& scene, const LocalVpls& vpls,
                              const Buffer<ReceiverPacket>& receivers, std::size_t first_packet,
                              std::size_t packet_count, const LocalLightPlan& plan, LocalLightSlots& slots) {
    const std::size_t slot_count = packet_count * NEARLIGHT_PACKET_SIZE * plan.rays_per_receiver;
    const uint first = static_cast<uint>(first_packet);
    const LocalLightParams params{.law = law_of(plan),
                                  .first_packet = first,
                                  .slot_count = static_cast<uint>(slot_count),
                                  .rays_per_receiver = plan.rays_per_receiver,
                                  .vpl_count = static_cast<uint>(vpls.count),
                                  .connections = plan.connections,
                                  .bounce_count = plan.bounce_count,
                                  .direct_samples = plan.direct_samples,
                                  .pad0 = 0};
    rays_.launch_items(slot_count, scene, receivers, params, vpls.vpls, vpls.radii, slots.lights, slots.radii,
                       slots.flags);
    const std::size_t light_count = compaction_.list_set(slots.flags, slot_count, slots.indices);
    density_.launch_items(light_count, scene, receivers, first, plan.rays_per_receiver, slots.radii,
                          slots.indices, static_cast<uint>(light_count), slots.lights, slots.seen_by);
    return light_count;
}

std::size_t LocalLights::add(const DeviceScene& scene, const LocalVpls& vpls,
                             const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                             const LocalLightPlan& plan, Buffer<IrradiancePacket>& irradiance) {
    const std::size_t slots_per_packet = std::size_t{NEARLIGHT_PACKET_SIZE} * plan.rays_per_receiver;
    const std::size_t packets_at_a_time = std::clamp<std::size_t>(
        slots_at_a_time(*device_) / slots_per_packet, 1, std::max<std::size_t>(packet_count, 1));
    LocalLightSlots slots(*device_, packets_at_a_time * slots_per_packet);
    std::size_t light_count = 0;
    for (std::size_t first = 0; first < packet_count; first += packets_at_a_time) {
        const std::size_t packets = std::min(packets_at_a_time, packet_count - first);
        light_count += make(scene, vpls, receivers, first, packets, plan, slots);
        gather_.launch_items(packets * NEARLIGHT_PACKET_SIZE, scene, receivers, static_cast<uint>(first),
                             static_cast<uint>(packets * NEARLIGHT_PACKET_SIZE), plan.rays_per_receiver,
                             plan.clamp_radius, slots.lights, slots.radii, slots.flags, slots.seen_by,
                             irradiance);
    }
    return light_count;
}

}  // namespace nearlight::core
