// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "host/base/receivers.h"
#include "host/reference/camera_oracle.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/ray_comparison.h"
#include "host/reference/reference_gather.h"
#include "host/reference/synthetic_scene.h"
#include "host/reference/test_rooms.h"
#include "host/scene/camera.h"
#include "host/scene/emitters.h"
#include "host/stages/caustic_aims.h"
#include "host/stages/close_range.h"
#include "host/stages/first_surfaces.h"
#include "host/stages/light_tracer.h"
#include "host/stages/metropolis_chains.h"
#include "host/stages/receiver_paths.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kLightTriangles = 3000;

/// Whether a shadow ray of the receiver passes so near an edge that both answers are right.
bool is_excused(EdgeExcuse& edges, const Scene& scene, Vec3 x) {
    return std::any_of(scene.delta_emitters.begin(), scene.delta_emitters.end(),
                       [&](const Emitter& light) { return edges.excuses(light.position, x); });
}

}  // namespace

void check_direct_light(Device& device, CheckResult& result) {
    const Scene scene = make_delta_lit_room();
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<ReceiverPacket> receivers = make_camera_receivers(scene, bvh, 128, 96);
    std::vector<IrradiancePacket> expected(receivers.size());
    direct_reference(EmbreeScene(scene), scene, receivers, expected);

    const DeviceScene on_device = upload_scene(device, scene, bvh);
    const Buffer<ReceiverPacket> input(device, receivers);
    Buffer<IrradiancePacket> irradiance(device, receivers.size());
    Buffer<IrradiancePacket> indirect(device, receivers.size());
    ReceiverPaths(device).run({on_device, input, receivers.size(), {.seed = 1}}, irradiance, indirect);
    const std::vector<IrradiancePacket> found = irradiance.download();
    EdgeExcuse edges(bvh.triangles, on_device.host_info.extent);
    for (std::size_t r = 0; r < receivers.size() * NEARLIGHT_PACKET_SIZE; ++r) {
        const float want = irradiance_at(expected, r).y;
        const float have = irradiance_at(found, r).y;
        result.expect(std::abs(have - want) <= 2e-4f * (want + 0.01f) ||
                      is_excused(edges, scene, receiver_at(receivers, r).position));
    }
}

void check_light_tracing(Device& device, CheckResult& result) {
    const Vec3 albedo{0.8f, 0.5f, 0.3f};
    const Scene scene = make_even_room(albedo);
    double flux = 0;  // of each colour channel, because the lamp is white
    for (const Emitter& emitter : build_emitter_table(scene).emitters) {
        flux += static_cast<double>(kPi) * emitter.area * emitter.radiance.x;
    }
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    const CloseRange nothing{};
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&nothing, 1));
    region.triangles = Buffer<uint>(device, std::vector<uint>(scene.triangles.size(), 0));
    const LightWalks walks{
        .walk_count = 20'000, .bounce_count = 4, .min_survival = 0.6f, .max_survival = 0.6f, .seed = 3};
    std::array<std::array<double, 3>, 4> power{};
    for (const Vpl& vpl : LightTracer(device).run(on_device, region, KeepDeposits::all, walks)) {
        power.at(vpl.depth - 1)[0] += vpl.power.x;
        power[vpl.depth - 1][1] += vpl.power.y;
        power[vpl.depth - 1][2] += vpl.power.z;
    }
    double launched = walks.walk_count;
    std::array<double, 3> expected{flux, flux, flux};
    for (std::size_t depth = 0; depth < power.size(); ++depth, launched *= walks.max_survival) {
        for (std::size_t c = 0; c < 3; ++c) {
            expected[c] *= c == 0 ? albedo.x : (c == 1 ? albedo.y : albedo.z);
            // The number of walks that continue is rounded, and a few walks meet a crack between triangles.
            result.expect(std::abs(power[depth][c] - expected[c]) <= (1.5 / launched + 1e-3) * expected[c]);
        }
    }
}

void check_metropolis_chains(Device& device, CheckResult& result) {
    constexpr uint kChains = 8192;
    constexpr uint kDepths = 4;
    constexpr uint kSteps = 20;
    constexpr float kAlbedo = 0.5f;
    const Scene scene = make_even_room({kAlbedo, kAlbedo, kAlbedo});
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    PilotView blind;
    blind.importons.importons = Buffer<Importon>(device, 0);
    Gatherer gatherer(device);
    VplContribution contribution(device, gatherer);
    MetropolisChains metropolis(device, contribution);
    PathStates chains(device, kChains, kDepths);
    PathStates proposed(device, kChains, kDepths);
    std::vector<uint> indices(kChains);
    std::iota(indices.begin(), indices.end(), 0u);
    for (const float survival : {0.5f, 0.65f, 0.8f}) {
        const PathSpace space{.scene = on_device,
                              .view = blind,
                              .seed = 3,
                              .bounce_count = kDepths,
                              .depth_cdf = make_depth_cdf(device, kDepths, survival)};
        metropolis.seed(space, Buffer<uint>(device, std::span<const uint>(indices)), chains);
        for (uint step = 0; step < kSteps; ++step) {
            metropolis.advance(space, step, chains, proposed);
        }
        std::array<double, kDepths> share{};
        for (const Vpl& vpl : chains.vpls.download()) {
            share.at(vpl.depth - 1) += 1.0 / kChains;
        }
        for (uint i = 0; i < kDepths; ++i) {
            const double expected = std::pow(kAlbedo, i) * (1 - kAlbedo) / (1 - std::pow(kAlbedo, kDepths));
            result.expect(std::abs(share.at(i) - expected) <= 5 * std::sqrt(expected / kChains));
        }
    }
}

void check_caustic_walks(Device& device, CheckResult& result) {
    constexpr uint kWalks = 4096;
    const MirrorCorner corner = make_mirror_corner();
    const DeviceScene on_device = upload_scene(device, corner.scene, build_scene_bvh(corner.scene));
    const float tolerance = 1e-4f * on_device.host_info.extent;
    const std::vector<CausticLanding> landings = CausticWalks(device).run(on_device, 0, kWalks, 1);
    for (const CausticLanding& landing : landings) {
        // Light that a flat mirror reflects comes straight from the mirror image of the lamp.
        const Vec3 way = landing.target - landing.place;
        const Vec3 image = landing.place + (corner.lamp.y - landing.place.y) / way.y * way;
        const float across = 2 * corner.mirror_x - image.x - corner.lamp.x;
        const float along = image.z - corner.lamp.z;
        result.expect(std::abs(landing.place.y) <= tolerance &&
                      std::abs(landing.target.x - corner.mirror_x) <= tolerance &&
                      std::max(std::abs(across), std::abs(along)) <= corner.lamp_half_side + 10 * tolerance);
    }
    result.expect(landings.size() > kWalks / 50);
}

void check_camera_pass(Device& device, CheckResult& result) {
    const Scene scene = make_sphere_room(kLightTriangles);
    const Camera camera = make_camera(scene.camera, 150, 101);
    const CloseRange region = make_close_range(camera, 4.0f);
    const CameraBatch batch{.tile_row_count = tiles_across(camera.height)};
    const std::size_t packets = packet_count(batch, camera.width);
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<CameraVertex> vertices(device, packets * NEARLIGHT_PACKET_SIZE);
    CameraPass(device).run({.scene = on_device,
                            .camera = Buffer<Camera>(device, std::span(&camera, 1)),
                            .width = camera.width,
                            .close_range = Buffer<CloseRange>(device, std::span(&region, 1)),
                            .batch = batch,
                            .seed = 1},
                           {receivers, vertices});
    const CameraComparison comparison =
        compare_with_embree(scene, camera, region, receivers.download(), vertices.download());
    result.cases = comparison.receivers + comparison.absent;
    result.mismatches = comparison.mismatches;
}

void check_first_surfaces(Device& device, CheckResult& result) {
    const Scene scene = make_sphere_room(kLightTriangles);
    const Camera camera = make_camera(scene.camera, 150, 101);
    const SampleBlock block{.width = camera.width, .row_count = camera.height, .in_middle = true};
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    Buffer<uint> found(device, block.size());
    FirstSurfaces(device).run(on_device, Buffer<Camera>(device, std::span(&camera, 1)), block, 1, found);
    const EmbreeScene embree(scene);
    const float extent = max_component(bounds(scene).size());
    uint pixel = 0;
    for (const uint triangle : found.download()) {
        const RayQuery ray = pixel_ray(camera, pixel % camera.width, pixel / camera.width);
        const BvhHit hit = embree.closest_hit(ray.origin, ray.direction, ray.t_min, ray.t_max);
        const auto touches_edge = [&](uint of) {
            return of != ~0u && distance_to_triangle_edges(scene, of, ray, extent) <= kEdgeTolerance * extent;
        };
        result.expect(triangle == hit.triangle || touches_edge(hit.triangle) || touches_edge(triangle));
        ++pixel;
    }
}

}  // namespace nearlight::core
