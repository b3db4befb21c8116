// SPDX-License-Identifier: Apache-2.0
#include "host/base/math.h"
#include "host/selftest/checks.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "host/base/receivers.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/light_sampler.h"
#include "host/reference/surface.h"
#include "host/reference/test_rooms.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/reflectance.h"
#include "host/stages/local_lights.h"
#include "host/stages/receiver_paths.h"

namespace nearlight::core {
namespace {

/// Receivers at the centres of 64 triangles, spread evenly over the scene's list.
std::vector<ReceiverPacket> receivers_on(const Scene& scene) {
    const Vec3 scene_size = bounds(scene).size();
    std::vector<ReceiverPacket> packets(1);
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const Triangle& t = scene.triangles[lane * scene.triangles.size() / NEARLIGHT_PACKET_SIZE];
        const Vec3 a = scene.vertices[t.v0].position;
        const Vec3 b = scene.vertices[t.v1].position;
        const Vec3 c = scene.vertices[t.v2].position;
        const Vec3 n = normalize(cross(b - a, c - a));
        const float off = triangle_stand_off(a, b, c, scene_size);
        set_receiver(packets[0], lane, {(a + b + c) / 3.0f + n * off, n});
    }
    return packets;
}

std::vector<Vec3> lanes_of(const IrradiancePacket& packet) {
    std::vector<Vec3> lanes;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        lanes.push_back(irradiance_at(std::span(&packet, 1), lane));
    }
    return lanes;
}

constexpr LocalLightPlan kPlan{.clamp_radius = 0.1f,
                               .max_radius = 0.8f,
                               .radius_at_unit_light = 0.2f,
                               .rays_per_receiver = 2,
                               .connections = 0,
                               .direct_samples = 1,
                               .bounce_count = 1,
                               .seed = 3};
constexpr std::size_t kSlotsPerPacket = std::size_t{kPlan.rays_per_receiver} * NEARLIGHT_PACKET_SIZE;

/// The geometry term cosθx·cosθy / d² of two points, with visibility by Embree's ray. It is 0 for points
/// farther apart than `radius`, and for points in one plane, whatever rounding says.
double pair_geometry(const EmbreeScene& embree, const ReceiverPoint& x, const Vpl& light, float radius) {
    const Vec3 between = x.position - light.position;
    const double squared = dot(between, between);
    const double height = dot(light.normal, between);
    const double cosine = -dot(x.normal, between);
    const bool open = squared < radius * radius && height > 4e-6 && cosine > 0 &&
                      !embree.blocked(light.position, x.position);
    return open ? height * cosine / (squared * squared) : 0.0;
}

Vec3 light_at(const Scene& scene, const EmbreeScene& embree, const Vpl& light) {
    Vec3 irradiance{0, 0, 0};
    for (const Emitter& emitter : scene.delta_emitters) {
        irradiance += delta_light_irradiance(scene, embree, emitter, light.position, light.normal);
    }
    return irradiance;
}

/// Exitance (W/m²) of a local light's surface under the point and spot lights.
Vec3 exitance(const Scene& scene, const EmbreeScene& embree, const Vpl& light) {
    constexpr float kBack = 1e-3f;
    const BvhHit hit =
        embree.closest_hit(light.position + light.normal * kBack, -light.normal, 0.0f, kInfinity);
    if (hit.triangle == ~0u) {
        return {0, 0, 0};
    }
    const Surface surface = surface_at(scene, hit, -light.normal);
    return light_at(scene, embree, light) * diffuse_albedo(scene, *surface.material, surface.u, surface.v);
}

/// Whether `radius` is the first halving of the widest radius that is small enough for the irradiance there,
/// except for rounding.
bool radius_fits(float radius, Vec3 irradiance) {
    const float wanted = kPlan.radius_at_unit_light / std::sqrt(luminance(irradiance));
    float min_wanted = kPlan.max_radius;
    for (int level = 1; level < 4 && min_wanted > wanted * 1.001f; ++level) {
        min_wanted *= 0.5f;
    }
    float max_wanted = kPlan.max_radius;
    for (int level = 1; level < 4 && max_wanted > wanted * 0.999f; ++level) {
        max_wanted *= 0.5f;
    }
    return radius == std::max(min_wanted, kPlan.clamp_radius) ||
           radius == std::max(max_wanted, kPlan.clamp_radius);
}

/// The local lights of all packets, with the stage's input and output for them.
struct LocalCase {
    const Scene& scene;
    const EmbreeScene& embree;
    const std::vector<ReceiverPacket>& receivers;
    std::vector<Vpl> lights;
    std::vector<float> radii;
    std::vector<uint> flags;
    std::vector<std::uint64_t> seen_by;
};

std::span<const ReceiverPacket> packet_of(const LocalCase& data, std::size_t slot) {
    return std::span(data.receivers).subspan(slot / kSlotsPerPacket, 1);
}

bool is_excused(EdgeExcuse& edges, const LocalCase& data, std::size_t slot) {
    const Vec3 y = data.lights[slot].position;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const ReceiverPoint x = receiver_at(packet_of(data, slot), lane);
        if (!is_zero(x.normal) && length(x.position - y) < data.radii[slot] && edges.excuses(y, x.position)) {
            return true;
        }
    }
    return std::ranges::any_of(data.scene.delta_emitters,
                               [&](const Emitter& light) { return edges.excuses(y, light.position); });
}

/// Whether a light is right: its radius follows the law, its power is the exitance divided by the density of
/// all rays of the packet, and its bits are the receivers that see it.
bool light_fits(const LocalCase& data, std::size_t slot) {
    const Vpl& light = data.lights[slot];
    double density = 0;
    std::uint64_t seen_by = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const double geometry =
            pair_geometry(data.embree, receiver_at(packet_of(data, slot), lane), light, data.radii[slot]);
        density += kPlan.rays_per_receiver * geometry / static_cast<double>(kPi);
        seen_by |= std::uint64_t{geometry > 0 ? 1u : 0u} << lane;
    }
    const Vec3 want = exitance(data.scene, data.embree, light) / static_cast<float>(density);
    return radius_fits(data.radii[slot], light_at(data.scene, data.embree, light)) &&
           seen_by == data.seen_by[slot] && length(light.power - want) <= 1e-3f * length(want);
}

/// The sum of power/π · (G_R − G_Rg) over the lights that see the receiver according to the kernel's own
/// bits.
double sum_of_lights(const LocalCase& data, std::size_t receiver) {
    const ReceiverPoint x = receiver_at(data.receivers, receiver);
    const std::size_t first = receiver / NEARLIGHT_PACKET_SIZE * kSlotsPerPacket;
    double sum = 0;
    for (std::size_t slot = first; slot < first + kSlotsPerPacket; ++slot) {
        const Vpl& light = data.lights[slot];
        if (data.flags[slot] == 0 || (data.seen_by[slot] >> receiver % NEARLIGHT_PACKET_SIZE & 1u) == 0) {
            continue;
        }
        const Vec3 between = x.position - light.position;
        const double squared = dot(between, between);
        const double cosines = -double{dot(x.normal, between)} * dot(light.normal, between) / squared;
        const auto bounded = [&](float radius) {
            return cosines / std::max(squared, double{radius} * radius);
        };
        sum += light.power.y / static_cast<double>(kPi) *
               (bounded(kPlan.clamp_radius) - bounded(data.radii[slot]));
    }
    return sum;
}

}  // namespace

// In a sphere of radius r a cosine-distributed ray meets the wall at a distance t with t²/4r² uniform in [0,
// 1], so that a clamp radius R ≤ 2r takes away R²/8r² of the light. The wall is equally bright everywhere.
void check_receiver_paths(Device& device, CheckResult& result) {
    constexpr float kRadius = 2.0f;
    constexpr float kAlbedo = 0.8f;
    constexpr uint kSamples = 4096;
    const Scene scene = make_lit_sphere(kRadius, kAlbedo);
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    const Buffer<ReceiverPacket> receivers(device, receivers_on(scene));
    ReceiverPaths stage(device);
    for (const uint bounces : {1u, 2u, 4u}) {
        const double light = (1 - std::pow(kAlbedo, bounces)) / (1 - kAlbedo) * kAlbedo / (kRadius * kRadius);
        for (const float clamp_radius : {0.5f * kRadius, kRadius, 2 * kRadius, kInfinity}) {
            const double share =
                clamp_radius < kInfinity ? std::pow(double{clamp_radius} / kRadius, 2) / 8 : 1.0;
            Buffer<IrradiancePacket> direct(device, 1);
            Buffer<IrradiancePacket> indirect(device, 1);
            stage.run({on_device,
                       receivers,
                       1,
                       {.rays = kSamples, .max_edges = bounces + 1, .clamp_radius = clamp_radius, .seed = 4}},
                      direct, indirect);
            // Single receivers are compared only where no path ends by chance, which adds noise: up to two
            // bounces, if rays bring all light.
            double mean = 0;
            for (const Vec3 found : lanes_of(indirect.download_one(0))) {
                mean += found.y / NEARLIGHT_PACKET_SIZE;
                if (bounces < 3 && clamp_radius == kInfinity) {
                    result.expect(std::abs(found.y - share * light) <= 0.03 * share * light);
                }
            }
            result.expect(std::abs(mean - share * light) <= 0.03 * share * light);
        }
    }
}

void check_local_lights(Device& device, CheckResult& result) {
    const Scene scene = make_delta_lit_room();
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<ReceiverPacket> receivers = make_camera_receivers(scene, bvh, 48, 48);
    const DeviceScene on_device = upload_scene(device, scene, bvh);
    const EmbreeScene embree(scene);
    const Buffer<ReceiverPacket> input(device, receivers);
    const LocalVpls no_vpls(device);
    LocalLights stage(device);
    LocalLightSlots slots(device, receivers.size() * kSlotsPerPacket);
    stage.make(on_device, no_vpls, input, 0, receivers.size(), kPlan, slots);
    Buffer<IrradiancePacket> irradiance(device, receivers.size());
    irradiance.fill_zero();
    stage.add(on_device, no_vpls, input, receivers.size(), kPlan, irradiance);
    const LocalCase data{scene,
                         embree,
                         receivers,
                         slots.lights.download(),
                         slots.radii.download(),
                         slots.flags.download(),
                         slots.seen_by.download()};
    EdgeExcuse edges(bvh.triangles, on_device.host_info.extent);
    for (std::size_t slot = 0; slot < data.lights.size(); ++slot) {
        if (data.flags[slot] != 0) {
            result.expect(light_fits(data, slot) || is_excused(edges, data, slot));
        }
    }
    const std::vector<IrradiancePacket> found = irradiance.download();
    for (std::size_t i = 0; i < receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        const double want = sum_of_lights(data, i);
        result.expect(std::abs(irradiance_at(found, i).y - want) <= 1e-4 * want + 1e-9);
    }
}

}  // namespace nearlight::core
