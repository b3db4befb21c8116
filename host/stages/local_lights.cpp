// SPDX-License-Identifier: Apache-2.0
#include "host/stages/local_lights.h"

#include <algorithm>

namespace nearlight {
namespace {

/// Slots that are worked on at a time: enough to keep the device busy, a few dozen MiB at most.
std::size_t slots_at_a_time(const Device& device) {
    const std::size_t wanted = device.is_cpu() ? std::size_t{1} << 17u : std::size_t{1} << 20u;
    return std::min(wanted, device.entry().max_allocation_bytes / (2 * sizeof(Vpl)));
}

}  // namespace

LocalLights::LocalLights(Device& device)
    : device_(&device),
      program_(device, "local_lights.cl"),
      rays_(program_, "local_light_rays"),
      density_(program_, "local_light_density"),
      gather_(program_, "local_light_gather"),
      compaction_(device) {}

std::size_t LocalLights::make(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                              const Buffer<ReceiverPacket>& receivers, std::size_t first_packet,
                              std::size_t packet_count, const LocalLightPlan& plan, LocalLightSlots& slots) {
    const std::size_t slot_count = packet_count * NEARLIGHT_PACKET_SIZE * plan.rays_per_receiver;
    const uint first = static_cast<uint>(first_packet);
    rays_.launch_items(slot_count, scene, receivers, first, static_cast<uint>(slot_count),
                       plan.rays_per_receiver, plan.gather_radius, vpls, static_cast<uint>(vpl_count),
                       plan.connections, plan.bounce_count, plan.direct_samples, plan.seed, slots.lights,
                       slots.flags);
    const std::size_t light_count = compaction_.list_set(slots.flags, slot_count, slots.indices);
    density_.launch_items(light_count, scene, receivers, first, plan.rays_per_receiver, plan.gather_radius,
                          slots.indices, static_cast<uint>(light_count), slots.lights, slots.seen_by);
    return light_count;
}

std::size_t LocalLights::add(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                             const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                             float clamp_radius, const LocalLightPlan& plan,
                             Buffer<IrradiancePacket>& irradiance) {
    const std::size_t slots_per_packet = std::size_t{NEARLIGHT_PACKET_SIZE} * plan.rays_per_receiver;
    const std::size_t packets_at_a_time = std::clamp<std::size_t>(
        slots_at_a_time(*device_) / slots_per_packet, 1, std::max<std::size_t>(packet_count, 1));
    LocalLightSlots slots(*device_, packets_at_a_time * slots_per_packet);
    std::size_t light_count = 0;
    for (std::size_t first = 0; first < packet_count; first += packets_at_a_time) {
        const std::size_t packets = std::min(packets_at_a_time, packet_count - first);
        light_count += make(scene, vpls, vpl_count, receivers, first, packets, plan, slots);
        gather_.launch_items(packets * NEARLIGHT_PACKET_SIZE, scene, receivers, static_cast<uint>(first),
                             static_cast<uint>(packets * NEARLIGHT_PACKET_SIZE), plan.rays_per_receiver,
                             plan.gather_radius, clamp_radius, slots.lights, slots.flags, slots.seen_by,
                             irradiance);
    }
    device_->finish();  // the slots must outlive the kernels
    return light_count;
}

}  // namespace nearlight
