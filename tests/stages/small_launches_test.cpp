// SPDX-License-Identifier: Apache-2.0
// Small launches (small_launches.h) of the stages that follow light.
#include <numeric>

#include "host/bvh/bvh.h"
#include "host/reference/test_rooms.h"
#include "host/scene/camera.h"
#include "host/stages/camera_pass.h"
#include "host/stages/caustic_aims.h"
#include "host/stages/close_range.h"
#include "host/stages/film.h"
#include "host/stages/first_surfaces.h"
#include "host/stages/light_cuts.h"
#include "host/stages/light_tracer.h"
#include "host/stages/light_visibility.h"
#include "host/stages/local_lights.h"
#include "host/stages/metropolis_chains.h"
#include "host/stages/patch_vpls.h"
#include "host/stages/receiver_paths.h"
#include "host/stages/reverse_vpls.h"
#include "host/stages/roulette.h"
#include "kernels/shared/film_layers.h"
#include "tests/stages/small_launches.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::bright_corner;
using test::few_receivers;
using test::Numbers;
using test::numbers_of;
using test::SmallLaunchesTest;

Numbers numbers_of(const std::vector<Vpl>& vpls) {
    Numbers numbers;
    for (const Vpl& vpl : vpls) {
        numbers.insert(numbers.end(), {vpl.position.x, vpl.position.y, vpl.position.z, vpl.power.y});
    }
    return numbers;
}

TEST_F(SmallLaunchesTest, CameraPassAndFilm) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        const Camera camera = make_camera(scene.scene.camera, 5, 3);
        const CloseRange region = make_close_range(camera, 1.5f);
        const CameraBatch batch{.tile_row_count = tiles_across(camera.height), .branch_count = 2};
        const std::size_t packets = packet_count(batch, camera.width);
        Buffer<ReceiverPacket> receivers(device, packets);
        Buffer<CameraVertex> vertices(device, packets * NEARLIGHT_PACKET_SIZE);
        CameraPass(device).run({.scene = scene.buffers,
                                .camera = Buffer<Camera>(device, std::span(&camera, 1)),
                                .width = camera.width,
                                .close_range = Buffer<CloseRange>(device, std::span(&region, 1)),
                                .batch = batch,
                                .seed = 1},
                               {receivers, vertices});
        Buffer<IrradiancePacket> direct(device, packets);
        Buffer<IrradiancePacket> indirect(device, packets);
        ReceiverPaths(device).run(
            {scene.buffers,
             receivers,
             packets,
             {.light_samples = 1, .rays = 1, .max_edges = 3, .clamp_radius = 0.3f, .seed = 2}},
            direct, indirect);
        const std::size_t pixels = std::size_t{camera.width} * camera.height;
        Buffer<float> sums(device, pixels * NEARLIGHT_FILM_CHANNELS);
        Buffer<float> layers(device, pixels * NEARLIGHT_LAYER_CHANNELS);
        sums.fill_zero();
        Film film(device);
        film.add(receivers, vertices, {.direct = direct, .gathered = indirect, .indirect = indirect}, batch,
                 camera.width, camera.height, sums);
        film.resolve(sums, pixels, 1, layers);
        return layers.download();
    });
}

TEST_F(SmallLaunchesTest, FirstSurfaces) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        const Camera camera = make_camera(scene.scene.camera, 5, 3);
        const SampleBlock block{.width = camera.width, .row_count = camera.height, .in_middle = true};
        Buffer<uint> found(device, block.size());
        FirstSurfaces(device).run(scene.buffers, Buffer<Camera>(device, std::span(&camera, 1)), block, 1,
                                  found);
        const std::vector<uint> triangles = found.download();
        return Numbers(triangles.begin(), triangles.end());
    });
}

TEST_F(SmallLaunchesTest, LightWalks) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        const CloseRange region_of_camera = make_close_range(make_camera(scene.scene.camera, 5, 3), 1.5f);
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::span(&region_of_camera, 1));
        region.triangles = Buffer<uint>(device, std::vector<uint>(scene.scene.triangles.size(), 1));
        return numbers_of(LightTracer(device).run(
            scene.buffers, region, KeepDeposits::all,
            {.walk_count = 24, .bounce_count = 2, .min_survival = 0.6f, .max_survival = 0.6f, .seed = 3}));
    });
}

/// Where walks over a mirror land, and what receivers on the floor gain by aiming at it.
TEST_F(SmallLaunchesTest, LightOverAMirror) {
    expect_same_of_both_trees([](Device& device) {
        const Scene scene = make_mirror_corner().scene;
        DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
        const std::vector<CausticLanding> landings = CausticWalks(device).run(on_device, 0, 256, 1);
        const CausticCells cells = sort_into_cells(landings, on_device.host_info.extent);
        on_device.caustic_aims.table = cells.table;
        on_device.caustic_aims.cells = Buffer<CausticCell>(device, cells.entries);
        on_device.caustic_aims.targets = Buffer<Vec3>(device, cells.targets);
        const std::vector<ReceiverPacket> packets =
            test::pack_receivers({{{0.3f, 1e-4f, 0}, {0, 1, 0}}, {{-0.2f, 1e-4f, 0.1f}, {0, 1, 0}}});
        const CausticErrors errors =
            ReceiverPaths(device).caustic_errors({on_device,
                                                  Buffer<ReceiverPacket>(device, packets),
                                                  packets.size(),
                                                  {.rays = 2, .aimed_rays = 2, .max_edges = 4, .seed = 5}});
        Numbers numbers(errors.aimed);
        numbers.insert(numbers.end(), errors.unaimed.begin(), errors.unaimed.end());
        for (const CausticLanding& landing : landings) {
            numbers.insert(numbers.end(), {landing.place.x, landing.place.z, landing.target.y});
        }
        return numbers;
    });
}

TEST_F(SmallLaunchesTest, LightsAndSidesOfTriangles) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        Buffer<uint> lit(device, std::vector<uint>(scene.scene.triangles.size(), 0));
        const std::vector<uint> ids{0, 1, 2, 3};
        LightVisibility(device).run(scene.buffers, Buffer<uint>(device, ids), ids.size(), 3, lit);
        SurfaceSample sample{};
        sample.position = {0, -1, 0};
        sample.normal = {0, 1, 0};
        const std::vector<SurfaceSample> samples(3, sample);
        const CloseRange range = make_close_range(make_camera(scene.scene.camera, 5, 3), 5.0f);
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::span(&range, 1));
        Buffer<Vpl> vpls(device, 2 * samples.size());
        Buffer<uint> present(device, 2 * samples.size());
        PatchVpls(device).run(scene.buffers, Buffer<SurfaceSample>(device, samples), samples.size(), region,
                              1.0f, vpls, present);
        Numbers found;
        for (const Buffer<uint>* const flags : {&lit, &present}) {
            const std::vector<uint> values = flags->download();
            found.insert(found.end(), values.begin(), values.end());
        }
        return found;
    });
}

/// The light of a few VPLs: of all, of those of the roulette, and of those of cuts.
Numbers gathers(Device& device, GatherKernel kernel) {
    const test::SceneOnDevice scene(device, bright_corner());
    const std::vector<ReceiverPacket> packets = few_receivers(scene, 16, 8);
    const Buffer<ReceiverPacket> receivers(device, packets);
    const Buffer<Vpl> vpls(device, make_traced_vpls(scene.scene, scene.bvh, 12));
    const DeviceTree tree = upload_both_trees(device, scene.bvh);
    GatherSums<Vpl> sums(device, packets.size());
    Gatherer gatherer(device, {.kernel = kernel});
    GatherInput<Vpl> input{tree, vpls, vpls.count(), receivers, packets.size(), 0.1f};
    gatherer.gather_recorded(input, sums);
    Numbers found = numbers_of(sums.light.download());
    const auto add_selected = [&](const VplSelection& selection) {
        input.selection = &selection;
        gatherer.gather(input, sums);
        const Numbers more = numbers_of(sums.light.download());
        found.insert(found.end(), more.begin(), more.end());
    };
    Roulette roulette(device);
    add_selected(roulette.select({.vpls = vpls,
                                  .vpl_count = vpls.count(),
                                  .receivers = receivers,
                                  .packet_count = packets.size(),
                                  .clamp_radius = 0.1f,
                                  .threshold = 1.0f,
                                  .seed = 1}));
    LightCuts cuts(device);
    const CutTree cut_tree = cuts.make_tree(vpls, vpls.count());
    const VplStrata strata(device, 1, std::vector{0u});
    add_selected(cuts.select({.vpls = vpls,
                              .tree = cut_tree,
                              .receivers = receivers,
                              .packet_count = packets.size(),
                              .strata = strata,
                              .clamp_radius = 0.1f,
                              .asked_count = 4,
                              .seed = 1}));
    return found;
}

TEST_F(SmallLaunchesTest, GathersOfPackets) {
    expect_same_of_both_trees([](Device& device) { return gathers(device, GatherKernel::packets); });
}

TEST_F(SmallLaunchesTest, GathersOfRays) {
    expect_same_of_both_trees([](Device& device) { return gathers(device, GatherKernel::rays); });
}

TEST_F(SmallLaunchesTest, LocalLightsOfAPacket) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        const std::vector<ReceiverPacket> packets = few_receivers(scene, 8, 8);
        const LocalLightPlan plan{.clamp_radius = 0.1f,
                                  .max_radius = 0.8f,
                                  .radius_at_unit_light = 0.4f,
                                  .bounce_count = 2,
                                  .seed = 3};
        LocalLights stage(device);
        const LocalVpls vpls = stage.group(scene.buffers, make_traced_vpls(scene.scene, scene.bvh, 6), plan);
        Buffer<IrradiancePacket> irradiance(device, packets.size());
        irradiance.fill_zero();
        stage.add(scene.buffers, vpls, Buffer<ReceiverPacket>(device, packets), packets.size(), plan,
                  irradiance);
        return numbers_of(irradiance.download());
    });
}

/// The importons of a few receivers on the scene.
std::vector<Importon> few_importons(const test::SceneOnDevice& scene) {
    const std::vector<ReceiverPacket> packets = few_receivers(scene, 8, 8);
    CameraVertex vertex{};
    vertex.throughput = vertex.albedo = {0.5f, 0.5f, 0.5f};
    std::vector<Importon> importons =
        make_importons(packets, std::vector(packets.size() * NEARLIGHT_PACKET_SIZE, vertex));
    importons.resize(6);
    return importons;
}

/// A room in which no walk is lost.
Scene closed_room() {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 0, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    add_point_light(scene, {0.2f, 0.1f, -0.3f}, {1, 1, 1});
    set_camera(scene, {0, 0, -0.5}, {0, -0.2, 1}, 70);
    return scene;
}

TEST_F(SmallLaunchesTest, ChainsOfPaths) {
    expect_same_of_both_trees([](Device& device) {
        constexpr uint kChains = 4;
        constexpr uint kDepths = 2;
        const test::SceneOnDevice scene(device, closed_room());
        PilotView view;
        set_importons(device, view, few_importons(scene));
        Gatherer gatherer(device);
        VplContribution contribution(device, gatherer);
        MetropolisChains metropolis(device, contribution);
        PathStates chains(device, kChains, kDepths);
        PathStates proposed(device, kChains, kDepths);
        std::vector<uint> indices(kChains);
        std::iota(indices.begin(), indices.end(), 0u);
        const PathSpace space{.scene = scene.buffers,
                              .view = view,
                              .clamp_radius = 0.1f,
                              .seed = 3,
                              .bounce_count = kDepths,
                              .depth_cdf = make_depth_cdf(device, kDepths, 0.6f)};
        metropolis.seed(space, Buffer<uint>(device, std::span<const uint>(indices)), chains);
        metropolis.advance(space, 0, chains, proposed);
        Buffer<Vpl> kept(device, kChains);
        metropolis.keep(chains, 1.0f, kept, 0);
        const GroupContribution parts = contribution.by_group(scene.buffers, kept, kChains, view, 0.1f);
        Numbers found = numbers_of(kept.download());
        found.insert(found.end(), parts.errors.begin(), parts.errors.end());
        return found;
    });
}

TEST_F(SmallLaunchesTest, TreeOfVplsOfSeveralLevels) {
    on_each_device([](Device& device) {
        constexpr std::size_t kVpls = NEARLIGHT_CUT_FANOUT * NEARLIGHT_CUT_MAX_ROOTS + 3;
        Vpl vpl{};
        vpl.normal = {0, 1, 0};
        vpl.power = {kPi, kPi, kPi};
        LightCuts cuts(device);
        const CutTree tree = cuts.make_tree(Buffer<Vpl>(device, std::vector<Vpl>(kVpls, vpl)), kVpls);
        const std::vector<CutNode> nodes = tree.nodes.download();
        float power = 0;
        for (uint root = 0; root < tree.root_count(); ++root) {
            power += nodes[tree.first_root() + root].power;
        }
        EXPECT_GE(tree.first_nodes.size(), 3u);
        EXPECT_NEAR(power, static_cast<float>(kVpls), 1e-3f * kVpls);
    });
}

TEST_F(SmallLaunchesTest, ReverseVplsAndTheirDensity) {
    expect_same_of_both_trees([](Device& device) {
        const test::SceneOnDevice scene(device, bright_corner());
        const CameraPoints points = make_camera_points(device, few_importons(scene), 3);
        Gatherer gatherer(device);
        ReverseVpls stage(device, gatherer);
        const std::vector<Vpl> vpls = stage.trace(scene.buffers, points, 17);
        const std::vector<ReceiverPacket> packets = few_receivers(scene, 8, 8);
        GatherSums<Importon> density(device, packets.size());
        stage.measure_density(scene.buffers, points, Buffer<ReceiverPacket>(device, packets), packets.size(),
                              density);
        return numbers_of(vpls);
    });
}

}  // namespace
}  // namespace nearlight::core
