// SPDX-License-Identifier: Apache-2.0
#include "host/stages/reverse_vpls.h"

namespace nearlight::core {

CameraPoints make_camera_points(Device& device, std::span<const Importon> importons, uint rays_per_point) {
    std::vector<Importon> points(importons.begin(), importons.end());
    const auto rays = static_cast<float>(rays_per_point);
    for (Importon& point : points) {
        point.flags = 0;
        point.response = {rays, rays, rays};
    }
    return {.points = Buffer<Importon>(device, std::span<const Importon>(points)),
            .count = static_cast<uint>(points.size()),
            .rays_per_point = rays_per_point};
}

ReverseVpls::ReverseVpls(Device& device, Gatherer& gatherer)
    : device_(&device),
      gatherer_(&gatherer),
      program_(device, "reverse_vpls.cl"),
      reverse_vpls_(program_, "reverse_vpls"),
      compaction_(device) {}

std::vector<Vpl> ReverseVpls::trace(const DeviceScene& scene, const CameraPoints& points, uint seed) {
    const std::size_t ray_count = std::size_t{points.count} * points.rays_per_point;
    Buffer<Vpl> slots(*device_, ray_count);
    Buffer<uint> flags(*device_, ray_count);
    reverse_vpls_.launch_items(ray_count, scene, points.points, points.count, points.rays_per_point, seed,
                               slots, flags);
    return compaction_.download_set(slots, flags, ray_count);
}

void ReverseVpls::measure_density(const DeviceScene& scene, const CameraPoints& points,
                                  const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                                  GatherSums<Importon>& density) {
    gatherer_->gather({.tree = scene.tree,
                       .vpls = points.points,
                       .vpl_count = points.count,
                       .receivers = receivers,
                       .packet_count = packet_count,
                       .clamp_radius = 0.0f},
                      density);
}

}  // namespace nearlight::core
