// SPDX-License-Identifier: Apache-2.0
#include "host/bench/gather_segments.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/receivers.h"
#include "host/reference/gather_workload.h"
#include "host/session/session.h"

namespace nearlight::core {
namespace {

/// The clamp radius as a part of the scene's extent. Without roulette the work does not depend on it.
constexpr float kClampRadiusShare = 0.01f;

Scene geometry_of(const Scene& scene) {
    Scene result;
    result.name = scene.name;
    result.vertices = scene.vertices;
    result.materials.emplace_back();
    for (const Triangle& triangle : scene.triangles) {
        result.triangles.push_back({triangle.v0, triangle.v1, triangle.v2, 0});
    }
    return result;
}

std::uint64_t lanes_that_face(const Vpl& vpl, const ReceiverPacket& packet, float clamp_radius_squared) {
    std::uint64_t lanes = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const ReceiverPoint receiver = receiver_at(packet, lane);
        const Vec3 segment = receiver.position - vpl.position;
        const float cos_vpl = dot(vpl.normal, segment);
        const float cos_receiver = -dot(receiver.normal, segment);
        const float r2 = dot(segment, segment);
        const float term = cos_vpl * cos_receiver / (r2 * std::max(r2, clamp_radius_squared));
        const bool faces = cos_vpl > 0.0f && cos_receiver > 0.0f && std::isfinite(term);
        lanes |= std::uint64_t{faces ? 1u : 0u} << lane;
    }
    return lanes;
}

}  // namespace

GatherSegments make_gather_segments(const Scene& scene, std::vector<Vpl> vpls,
                                    std::vector<ReceiverPacket> receivers, float clamp_radius) {
    GatherSegments segments{geometry_of(scene), std::move(vpls), std::move(receivers), clamp_radius, {}};
    segments.rays.reserve(segments.receivers.size() * segments.vpls.size());
    for (const ReceiverPacket& packet : segments.receivers) {
        for (const Vpl& vpl : segments.vpls) {
            segments.rays.push_back(lanes_that_face(vpl, packet, clamp_radius * clamp_radius));
        }
    }
    return segments;
}

GatherSegments make_camera_segments(const Scene& scene, const Bvh& bvh, std::size_t vpl_count, int width,
                                    int height) {
    return make_gather_segments(scene, make_traced_vpls(scene, bvh, vpl_count),
                                make_camera_receivers(scene, bvh, width, height),
                                kClampRadiusShare * max_component(bounds(scene).size()));
}

GatherSegments make_rendered_segments(Device& device, const Scene& scene, const Bvh& bvh,
                                      std::size_t vpl_count, int width, int height) {
    Session session(device, scene);
    const View view = session.look({.width = width, .height = height}, 0);
    const VplSet set = session.sample(view, {.vpl_count = static_cast<uint>(vpl_count)}, 0);
    std::vector<Vpl> vpls = set.vpls.download();
    sort_along_morton_curve(scene, vpls);
    return make_gather_segments(scene, std::move(vpls), make_camera_receivers(scene, bvh, width, height),
                                budget_of(view, set, {}).clamp_radius);
}

std::uint64_t count_bits(std::span<const std::uint64_t> mask) {
    std::uint64_t count = 0;
    for (const std::uint64_t word : mask) {
        count += static_cast<std::uint64_t>(std::popcount(word));
    }
    return count;
}

std::uint64_t count_pairs(const GatherSegments& segments) {
    std::uint64_t present = 0;
    for (const ReceiverPacket& packet : segments.receivers) {
        present += present_count(packet);
    }
    return present * segments.vpls.size();
}

}  // namespace nearlight::core
