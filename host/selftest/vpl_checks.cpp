// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/reference/close_range_oracle.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/reference_gather.h"
#include "host/reference/surface.h"
#include "host/reference/test_rays.h"
#include "host/reference/test_rooms.h"
#include "host/scene/camera.h"
#include "host/scene/material_model.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/reflectance.h"
#include "host/stages/close_range.h"
#include "host/stages/patch_vpls.h"
#include "host/stages/pilot_view.h"
#include "host/stages/reverse_vpls.h"
#include "host/stages/vpl_contribution.h"

namespace nearlight::core {
namespace {

constexpr float kVplRadius = 0.05f;

Vec3 random_vector(Pcg32& random) {
    const float x = random.uniform();
    const float y = random.uniform();
    return {x, y, random.uniform()};
}

std::vector<Vpl> random_vpls(std::size_t count) {
    Pcg32 random(8);
    std::vector<Vpl> vpls(count);
    for (Vpl& vpl : vpls) {
        vpl.position = random_vector(random);
        vpl.normal = random_vector(random);
        vpl.power = random_vector(random);
    }
    return vpls;
}

/// Packets in which the irradiance of lane i is (i, 2i, 1). These numbers and their doubles are exact in
/// single precision.
std::vector<IrradiancePacket> ramp(std::size_t packets) {
    std::vector<IrradiancePacket> light(packets);
    for (std::size_t i = 0; i < packets * NEARLIGHT_PACKET_SIZE; ++i) {
        const auto value = static_cast<float>(i);
        light[i / NEARLIGHT_PACKET_SIZE].r[i % NEARLIGHT_PACKET_SIZE] = value;
        light[i / NEARLIGHT_PACKET_SIZE].g[i % NEARLIGHT_PACKET_SIZE] = 2 * value;
        light[i / NEARLIGHT_PACKET_SIZE].b[i % NEARLIGHT_PACKET_SIZE] = 1;
    }
    return light;
}

/// Random samples on triangles of the scene. Every second sample is two-sided.
std::vector<SurfaceSample> random_samples(const Scene& scene, std::size_t count) {
    Pcg32 random(12);
    std::vector<SurfaceSample> samples;
    while (samples.size() < count) {
        const auto id = static_cast<uint>(random.next() % scene.triangles.size());
        const Triangle& t = scene.triangles[id];
        const Vec3 a = scene.vertices[t.v0].position;
        const Vec3 b = scene.vertices[t.v1].position - a;
        const Vec3 c = scene.vertices[t.v2].position - a;
        const Vec3 normal = normalize(cross(b, c));
        if (is_zero(normal)) {
            continue;
        }
        const float u = random.uniform();
        const float v = (1 - u) * random.uniform();
        SurfaceSample& sample = samples.emplace_back();
        sample.u = u;
        sample.v = v;
        sample.position = a + b * u + c * v;
        sample.triangle = id;
        sample.normal = normal;
    }
    return samples;
}

/// The light of a VPL that each receiver sends to the camera; `response` is the camera's.
std::vector<Vec3> seen_of(const EmbreeScene& embree, const Vpl& vpl,
                          std::span<const ReceiverPacket> receivers, std::span<const CameraVertex> response) {
    std::vector<IrradiancePacket> irradiance(receivers.size());
    gather_reference(embree, std::span(&vpl, 1), kVplRadius, receivers, irradiance);
    std::vector<Vec3> seen;
    for (std::size_t i = 0; i < response.size(); ++i) {
        seen.push_back(response[i].throughput * response[i].albedo * irradiance_at(irradiance, i) *
                       (1 / kPi));
    }
    return seen;
}

double column_sum(std::span<const Vec3> seen) {
    double sum = 0;
    for (const Vec3 light : seen) {
        sum += luminance(light);
    }
    return sum;
}

/// The square of the importance that a receiver would send to a VPL if nothing were in the way, up to a
/// factor.
double squared_importance(const Vpl& vpl, const ReceiverPoint& x, const CameraVertex& response) {
    const Vec3 segment = x.position - vpl.position;
    const double r2 = dot(segment, segment);
    const double cosines = std::max(0.0, static_cast<double>(dot(vpl.normal, segment))) *
                           std::max(0.0, -static_cast<double>(dot(x.normal, segment)));
    const double term = r2 > 0 ? cosines / (r2 * std::max<double>(r2, kVplRadius * kVplRadius)) : 0.0;
    const Vec3 color = response.throughput * response.albedo;
    return term * term * dot(color, color);
}

/// The root of the sum of squares over the receivers that are asked about the VPL. There are `importon_count`
/// importons in all; those beyond `response` send nothing.
double column_error(std::span<const Vec3> seen, const Vpl& vpl, std::span<const ReceiverPacket> receivers,
                    std::span<const CameraVertex> response, std::size_t importon_count) {
    std::vector<double> squares;
    double total = 0;
    for (std::size_t i = 0; i < response.size(); ++i) {
        squares.push_back(squared_importance(vpl, receiver_at(receivers, i), response[i]));
        total += squares.back();
    }
    const double min_square = VplContribution::kNegligiblePart * total / static_cast<double>(importon_count);
    double sum = 0;
    for (std::size_t i = 0; i < response.size(); ++i) {
        sum += squares[i] >= min_square ? dot(seen[i], seen[i]) : 0.0;
    }
    return std::sqrt(sum);
}

bool any_excused(EdgeExcuse& edges, const Vpl& vpl, std::span<const ReceiverPacket> receivers) {
    for (std::size_t i = 0; i < receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        const ReceiverPoint x = receiver_at(receivers, i);
        if (!is_zero(x.normal) && edges.excuses(vpl.position, x.position)) {
            return true;
        }
    }
    return false;
}

/// Whether Embree's ray from `point` towards `vpl` lands there.
bool landed_right(const Scene& scene, const EmbreeScene& embree, float extent, const Importon& point,
                  const Vpl& vpl) {
    const Vec3 direction = normalize(vpl.position - point.position);
    const BvhHit hit =
        embree.closest_hit(point.position, direction, 0.0f, std::numeric_limits<float>::infinity());
    if (hit.triangle == ~0u) {
        return false;
    }
    const Surface surface = surface_at(scene, hit, direction);
    const float slack = 2e-5f * extent / std::max(-dot(surface.geometric_normal, direction), 1e-3f);
    return length(surface.position - vpl.position) <= slack &&
           length(surface.geometric_normal - vpl.normal) <= 1e-4f &&
           length(diffuse_albedo(scene, *surface.material, surface.u, surface.v) - vpl.power) <= 1e-5f &&
           vpl.depth == 0;
}

}  // namespace

void check_vpl_light(Device& device, CheckResult& result) {
    constexpr std::size_t kCount = 1000;
    const std::size_t packets = receiver_packet_count(kCount);
    const std::vector<Vpl> vpls = random_vpls(kCount);
    const Buffer<IrradiancePacket> light(device, ramp(packets));
    VplLight stage(device);
    Buffer<Vpl> lit(device, vpls);
    Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<IrradiancePacket> sum(device, ramp(packets));
    stage.make_receivers(lit, kCount, VplSide::emits, receivers);
    stage.apply(light, kCount, lit);
    stage.add(light, packets, sum);
    const std::vector<Vpl> found = lit.download();
    const std::vector<ReceiverPacket> points = receivers.download();
    const std::vector<IrradiancePacket> sums = sum.download();
    for (std::size_t i = 0; i < packets * NEARLIGHT_PACKET_SIZE; ++i) {
        const ReceiverPoint point = receiver_at(points, i);
        const Vec3 irradiance{static_cast<float>(i), 2 * static_cast<float>(i), 1};
        result.expect(irradiance_at(sums, i) == irradiance * 2.0f);
        result.expect(point.position == (i < kCount ? vpls[i].position : Vec3{}) &&
                      point.normal == (i < kCount ? vpls[i].normal : Vec3{}));
        if (i < kCount) {
            result.expect(found[i].power == vpls[i].power * irradiance);
        }
    }
}

void check_patch_vpls(Device& device, CheckResult& result) {
    constexpr std::size_t kSamples = 4000;
    constexpr float kArea = 0.25f;  // m² per sample
    Scene scene = make_triangle_soup(1000, 23);
    scene.materials = {diffuse_material({0.5f, 0.25f, 0.125f})};
    add_two_sided(scene, diffuse_material({0.2f, 0.4f, 0.8f}));
    const std::array<Vec3, 2> albedos{Vec3{0.5f, 0.25f, 0.125f}, Vec3{0.2f, 0.4f, 0.8f}};
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        scene.triangles[i].material = i % 2 == 0 ? 0 : static_cast<uint>(scene.materials.size()) - 1;
    }
    scene.camera.to_world = look_at({0.3, -0.2, -1.5}, {-0.1, 0.1, 1.0}, {0.3, 1, 0.2});
    const CloseRange range = make_close_range(make_camera(scene.camera, 320, 200), 1.5f);
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    const Vec3 scene_size = on_device.host_info.size;
    const std::vector<SurfaceSample> samples = random_samples(scene, kSamples);
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&range, 1));
    Buffer<Vpl> vpls(device, 2 * kSamples);
    Buffer<uint> flags(device, 2 * kSamples);
    PatchVpls(device).run(on_device, Buffer<SurfaceSample>(device, samples), kSamples, region, kArea, vpls,
                          flags);
    const std::vector<Vpl> found = vpls.download();
    const std::vector<uint> present = flags.download();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const SurfaceSample& sample = samples[i / 2];
        const bool two_sided = scene.triangles[sample.triangle].material != 0;
        const bool reflects = i % 2 == 0 || two_sided;
        const bool right_flag =
            reflects ? close_flag_fits(range, sample.position, present[i] != 0, 1e-5f) : present[i] == 0;
        const Vec3 side = i % 2 == 0 ? sample.normal : -sample.normal;
        const float off = triangle_stand_off(scene, sample.triangle, scene_size);
        result.expect(right_flag &&
                      (present[i] == 0 ||
                       (found[i].normal == side && found[i].power == albedos[two_sided ? 1 : 0] * kArea &&
                        found[i].flags == NEARLIGHT_VPL_CLOSE &&
                        length(found[i].position - (sample.position + side * off)) < 1e-6f)));
    }
}

void check_vpl_contribution(Device& device, CheckResult& result) {
    const Scene scene = make_even_room({0.5f, 0.5f, 0.5f});
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<ReceiverPacket> receivers = make_camera_receivers(scene, bvh, 16, 16);
    const std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, 150);
    Pcg32 random(1);
    std::vector<CameraVertex> response(receivers.size() * NEARLIGHT_PACKET_SIZE);
    for (CameraVertex& vertex : response) {
        vertex.throughput = random_vector(random);
        vertex.albedo = random_vector(random);
    }
    PilotView view;
    set_importons(device, view, make_importons(receivers, response));
    const DeviceScene on_device = upload_scene(device, scene, bvh);
    const EmbreeScene embree(scene);
    EdgeExcuse edges(bvh.triangles, on_device.host_info.extent);
    Gatherer gatherer(device);
    VplContribution contribution(device, gatherer);
    const Buffer<Vpl> on_device_vpls(device, vpls);
    Buffer<float> brought(device, vpls.size());
    contribution.run(on_device, on_device_vpls, vpls.size(), view, kVplRadius, brought);
    const std::vector<float> sums = brought.download();
    const std::vector<float> errors =
        contribution.by_group(on_device, on_device_vpls, vpls.size(), view, kVplRadius).errors;
    // There are so few receivers that all of them are among the importons in groups.
    const std::size_t importon_count =
        std::size_t{view.importon_groups.group_count} * view.importon_groups.group_size;
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        const std::vector<Vec3> seen = seen_of(embree, vpls[i], receivers, response);
        const double sum = column_sum(seen);
        const double error = column_error(seen, vpls[i], receivers, response, importon_count);
        const bool excused = any_excused(edges, vpls[i], receivers);
        result.expect(std::abs(sums[i] - sum) <= 2e-4 * sum + 1e-9 || excused);
        result.expect(std::abs(errors[i] - error) <= 2e-4 * error + 1e-9 || excused);
    }
}

void check_reverse_vpls(Device& device, CheckResult& result) {
    constexpr uint kRaysPerPoint = 40;
    const Scene scene = make_even_room({0.8f, 0.5f, 0.3f});
    const Bvh bvh = build_scene_bvh(scene);
    const DeviceScene on_device = upload_scene(device, scene, bvh);
    const float extent = on_device.host_info.extent;
    std::vector<Importon> importons;
    for (const ReceiverPacket& packet : make_camera_receivers(scene, bvh, 64, 64)) {
        const ReceiverPoint x = receiver_at(std::span(&packet, 1), 0);  // one per tile
        Importon& importon = importons.emplace_back();
        importon.position = x.position;
        importon.normal = x.normal;
    }
    const CameraPoints points = make_camera_points(device, importons, kRaysPerPoint);
    Gatherer gatherer(device);
    ReverseVpls stage(device, gatherer);
    const std::vector<Vpl> found = stage.trace(on_device, points, 17);
    // The room is closed and all of it reflects, so every ray leaves a VPL.
    result.expect(found.size() == importons.size() * kRaysPerPoint);
    if (result.mismatches > 0) {
        return;
    }
    const EmbreeScene embree(scene);
    EdgeExcuse edges(bvh.triangles, extent);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Importon& point = importons[i / kRaysPerPoint];
        result.expect(landed_right(scene, embree, extent, point, found[i]) ||
                      edges.excuses(point.position, found[i].position));
    }
    const std::size_t packets = receiver_packet_count(found.size());
    Buffer<ReceiverPacket> receivers(device, packets);
    GatherSums<Importon> density(device, packets);
    VplLight(device).make_receivers(Buffer<Vpl>(device, found), found.size(), VplSide::emits, receivers);
    stage.measure_density(on_device, points, receivers, packets, density);
    std::vector<IrradiancePacket> expected(packets);
    const std::vector<ReceiverPacket> places = receivers.download();
    gather_reference(embree, as_vpls(points.points.download()), 0.0f, places, expected);
    const std::vector<ImportancePacket> densities = density.light.download();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const float want = irradiance_at(expected, i).y;
        const ReceiverPoint y = receiver_at(places, i);
        const bool right =
            std::abs(arrived_at(std::span<const ImportancePacket>(densities), i).y - want) <= 2e-4f * want;
        result.expect(right || std::ranges::any_of(importons, [&](const Importon& point) {
                          return edges.excuses(point.position, y.position);
                      }));
    }
}

}  // namespace nearlight::core
