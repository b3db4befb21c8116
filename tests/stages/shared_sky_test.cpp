// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_sky.h"

#include <algorithm>
#include <cmath>

#include "host/scene/camera.h"
#include "host/scene/material_model.h"
#include "host/stages/camera_pass.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class SharedSkyTest : public test::DeviceTest {};

constexpr int kPictureSide = 16;  // pixels of the picture's width and height

/// A room under a roof, with a window at each side, a table, and a sky of many colours. The camera looks at
/// the table and at the floor, which reflects a window.
Scene room_with_windows(const Material& floor) {
    Scene scene;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, floor));
    const uint white = add_two_sided(scene, lambertian({0.7f, 0.7f, 0.7f}));
    add_quad(scene, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, white);
    add_quad(scene, {-2, 0, 2}, {0, 2, 0}, {4, 0, 0}, white);
    add_quad(scene, {-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, white);
    add_quad(scene, {-2, 0, -2}, {0, 0.8f, 0}, {0, 0, 4}, white);
    add_quad(scene, {2, 0, -2}, {0, 0.4f, 0}, {0, 0, 4}, white);
    add_quad(scene, {-0.2f, 0.2f, 0.1f}, {0, 0, 0.4f}, {0.4f, 0, 0}, white);
    scene.environment = patterned_map(7, 4);
    for (std::size_t i = 0; i < scene.environment.radiance.size(); i += 3) {
        scene.environment.radiance[i] = {0, 0, 0};  // other receivers see light beside it
    }
    set_camera(scene, {-1.5, 0.7, 0}, {0.2, 0, 0}, 50);
    return scene;
}

/// Green light of each sample of the picture: direct irradiance of its receivers, and radiance that its
/// camera path met, in the mean over some seeds, and the mean of its squares.
struct Light {
    std::vector<double> direct, emitted, direct_square, emitted_square;

    static double mean(const std::vector<double>& values) {
        double sum = 0;
        for (const double value : values) {
            sum += value / static_cast<double>(values.size());
        }
        return sum;
    }
    static double variance(const std::vector<double>& values, const std::vector<double>& squares) {
        double sum = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            sum += (squares[i] - values[i] * values[i]) / static_cast<double>(values.size());
        }
        return sum;
    }
};

/// How the light is found.
struct Search {
    bool shared = true;
    uint rays = 2;
    int seeds = 1;
    GatherKernel kernel = GatherKernel::automatic;
};

/// The light of pictures of one sample through the middle of each pixel, whose surfaces are therefore the
/// same with all seeds.
Light find_light(Device& device, const Scene& scene, const Search& search) {
    const Bvh bvh = build_scene_bvh(scene);
    const DeviceScene on_device = upload_scene(device, scene, bvh, search.kernel);
    const Camera camera = make_camera(scene.camera, kPictureSide, kPictureSide);
    const CloseRange region = make_close_range(camera, 1.0f);
    const Buffer<Camera> cameras(device, std::span(&camera, 1));
    const Buffer<CloseRange> regions(device, std::span(&region, 1));
    const CameraBatch camera_batch{.tile_row_count = tiles_across(static_cast<uint>(kPictureSide)),
                                   .branch_count = 2,
                                   .bundle_columns = 2,
                                   .bundle_rows = 2,
                                   .max_depth = 4,
                                   .light_rays = search.rays,
                                   .sky_rays = search.shared ? search.rays : 0};
    const std::size_t packets = packet_count(camera_batch, static_cast<uint>(kPictureSide));
    const std::size_t count = packets * NEARLIGHT_PACKET_SIZE;
    Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<CameraVertex> vertices(device, count);
    Buffer<SeenSurface> seen(device, count);
    Buffer<IrradiancePacket> direct(device, packets);
    Buffer<IrradiancePacket> indirect(device, packets);
    FoundLights found(device, packets, {.shares_sky = true});
    CameraPass camera_pass(device);
    ReceiverPaths paths(device);
    SharedLightLists lists(device, search.kernel);
    SharedSky sky(device);
    Light light{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count),
                std::vector<double>(count)};
    for (int seed = 0; seed < search.seeds; ++seed) {
        const ReceiverPathSettings settings{.rays = search.rays,
                                            .max_edges = 3,
                                            .clamp_radius = 0.1f,
                                            .seed = 50u + static_cast<uint>(seed),
                                            .shares_sky = true};
        camera_pass.run(
            {on_device, cameras, static_cast<uint>(kPictureSide), regions, camera_batch, settings.seed},
            {receivers, vertices, &seen});
        const ReceiverBatch batch{on_device, receivers, packets, settings};
        if (search.shared) {
            paths.run_sharing(batch, direct, indirect, found);
            sky.add(batch, lists, found.sky, {.surfaces = seen, .vertices = vertices, .rays = search.rays},
                    direct);
        } else {
            paths.run(batch, direct, indirect);
        }
        const std::vector<IrradiancePacket> irradiance = direct.download();
        const std::vector<CameraVertex> met = vertices.download();
        for (std::size_t i = 0; i < count; ++i) {
            const double green = irradiance_at(irradiance, i).y;
            light.direct[i] += green / search.seeds;
            light.direct_square[i] += green * green / search.seeds;
            const double emitted = double{met[i].camera_light.y} + double{met[i].traced_direct.y};
            light.emitted[i] += emitted / search.seeds;
            light.emitted_square[i] += emitted * emitted / search.seeds;
        }
    }
    return light;
}

/// Light of both branches of a sample together, since each of them has a part of what its surface reflects.
/// The bundle of the second branch follows that of the first.
std::vector<double> of_samples(const std::vector<double>& light) {
    std::vector<double> sums(light.size() / 2);
    for (std::size_t i = 0; i < light.size(); ++i) {
        sums[i % sums.size()] += light[i];
    }
    return sums;
}

/// The receivers of the first branch, which are the same with all seeds.
std::vector<double> of_first_branch(const std::vector<double>& light) {
    return {light.begin(), light.begin() + static_cast<std::ptrdiff_t>(light.size() / 2)};
}

void expect_same_means(const std::vector<double>& found, const std::vector<double>& wanted,
                       double tolerance) {
    ASSERT_GT(Light::mean(wanted), 0.001);
    EXPECT_NEAR(Light::mean(found), Light::mean(wanted), 0.005 * Light::mean(wanted));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_NEAR(found[i], wanted[i], tolerance * (wanted[i] + Light::mean(wanted))) << i;
    }
}

void expect_the_light_of_own_rays(Device& device, const Scene& scene, GatherKernel kernel) {
    const Light own =
        find_light(device, scene, {.shared = false, .rays = 32, .seeds = 512, .kernel = kernel});
    const Light shared = find_light(device, scene, {.seeds = 2048, .kernel = kernel});
    expect_same_means(of_first_branch(shared.direct), of_first_branch(own.direct), 0.1);
    expect_same_means(of_samples(shared.emitted), of_samples(own.emitted), 0.2);
}

TEST_F(SharedSkyTest, BringsWhatOwnRaysBring) {
    on_each_device([](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::rays ? "single rays" : "packets");
            expect_the_light_of_own_rays(device, room_with_windows(lambertian({0.5f, 0.5f, 0.5f})), kernel);
        }
    });
}

Scene coated_room() {
    Scene scene = room_with_windows(lambertian({0.5f, 0.5f, 0.5f}));
    scene.materials[0] = coated(scene, {0.5f, 0.5f, 0.5f}, {.eta = 1.5, .alpha = 0.3});
    return scene;
}

/// Rough coats have a curve, and reflect the sky other than diffusely.
TEST_F(SharedSkyTest, BringsWhatOwnRaysBringOnCoats) {
    on_each_device(
        [](Device& device) { expect_the_light_of_own_rays(device, coated_room(), GatherKernel::automatic); });
}

/// What the floor reflects of the sky comes on top of what it sends out itself.
TEST_F(SharedSkyTest, BringsWhatOwnRaysBringOnLamps) {
    on_each_device([](Device& device) {
        Scene scene = coated_room();
        scene.materials[0].emission = parameter_of(0.1f);
        expect_the_light_of_own_rays(device, scene, GatherKernel::automatic);
    });
}

/// Light samples find bright spots of the sky far more often than rays of the bundle do, so that their
/// weights matter.
TEST_F(SharedSkyTest, BringsWhatOwnRaysBringOfBrightSpots) {
    on_each_device([](Device& device) {
        Scene scene = coated_room();
        scene.environment = patterned_map(32, 16);
        for (std::size_t i = 0; i < scene.environment.radiance.size(); i += 37) {
            scene.environment.radiance[i] = {100, 100, 100};
        }
        const Light own = find_light(device, scene, {.shared = false, .rays = 32, .seeds = 2048});
        const Light shared = find_light(device, scene, {.seeds = 8192});
        EXPECT_NEAR(Light::mean(shared.direct), Light::mean(own.direct), 0.008 * Light::mean(own.direct));
        EXPECT_NEAR(Light::mean(shared.emitted), Light::mean(own.emitted), 0.003 * Light::mean(own.emitted));
    });
}

TEST_F(SharedSkyTest, BringsWhatOwnRaysBringBesideAPane) {
    on_each_device([](Device& device) {
        Scene scene = coated_room();
        add_quad(scene, {-1.9f, 0, -2}, {0, 2, 0}, {0, 0, 2},
                 add_material(scene, thin_dielectric_material(1.5)));
        expect_the_light_of_own_rays(device, scene, GatherKernel::automatic);
    });
}

/// Closes one window with `panes` tinted panes, and the other with a lattice whose bars are opaque.
Scene glazed_room(int panes, const Material& pane) {
    Scene scene = coated_room();
    Material tinted = pane;
    tinted.transmission = parameter_of(Vec3{0.9f, 0.7f, 0.5f});
    const uint glass = add_material(scene, tinted);
    for (int i = 0; i < panes; ++i) {
        const float x = -1.99f + 0.02f * static_cast<float>(i);
        if (i % 2 == 0) {
            add_quad(scene, {x, 0.7f, -2}, {0, 1.3f, 0}, {0, 0, 4}, glass);
        } else {
            add_quad(scene, {x, 0.7f, -2}, {0, 0, 4}, {0, 1.3f, 0}, glass);
        }
    }
    const int bars = add_checkerboard(scene, 3, parameter_of(0.2f), parameter_of(1.0f));
    const uint bar = add_two_sided(scene, lambertian({0.3f, 0.3f, 0.3f}));
    const uint lattice = add_material(scene, mask_material(textured(bars), bar));
    add_quad(scene, {1.99f, 0.3f, -2}, {0, 1.7f, 0}, {0, 0, 4}, lattice);
    for (std::size_t corner = 0; corner < 4; ++corner) {
        Vertex& vertex = scene.vertices[scene.vertices.size() - 4 + corner];
        vertex.u = corner == 1 || corner == 2 ? 1.0f : 0.0f;
        vertex.v = corner >= 2 ? 1.0f : 0.0f;
    }
    return scene;
}

TEST_F(SharedSkyTest, BringsWhatOwnRaysBringThroughVeils) {
    on_each_device([](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::rays ? "single rays" : "packets");
            expect_the_light_of_own_rays(device, glazed_room(2, thin_dielectric_material(1.5)), kernel);
        }
    });
}

/// A pane overlaps the wall in its plane. Rays that meet the pane there pass the wall as well, and bundles do
/// not.
TEST_F(SharedSkyTest, BringsWhatOwnRaysBringThroughPanesInThePlaneOfTheWall) {
    on_each_device([](Device& device) {
        Scene scene = coated_room();
        add_quad(scene, {-2, 0.3f, -2}, {0, 1.7f, 0}, {0, 0, 4},
                 add_material(scene, thin_dielectric_material(1.5)));
        expect_the_light_of_own_rays(device, scene, GatherKernel::automatic);
    });
}

/// Paths of three edges have room for two veils only.
TEST_F(SharedSkyTest, BringsNothingThroughMoreVeilsThanPathsPass) {
    on_each_device([](Device& device) {
        const Scene scene = glazed_room(3, thin_dielectric_material(1.5));
        const Light three = find_light(device, scene, {.seeds = 64});
        const Light two = find_light(device, glazed_room(2, thin_dielectric_material(1.5)), {.seeds = 64});
        const Light own = find_light(device, scene, {.shared = false, .seeds = 64});
        EXPECT_NEAR(Light::mean(three.direct), Light::mean(own.direct), 0.02 * Light::mean(own.direct));
        EXPECT_LT(Light::mean(three.direct), 0.9 * Light::mean(two.direct));
    });
}

TEST_F(SharedSkyTest, BringsWhatOwnRaysBringThroughClearGlass) {
    on_each_device([](Device& device) {
        Scene scene = glazed_room(2, dielectric_material(1.5));
        scene.clear_glass = true;
        expect_the_light_of_own_rays(device, scene, GatherKernel::automatic);
    });
}

TEST_F(SharedSkyTest, IsLessNoiseThanOwnRaysThroughVeils) {
    on_each_device([](Device& device) {
        const Scene scene = glazed_room(1, thin_dielectric_material(1.5));
        const Light own = find_light(device, scene, {.shared = false, .seeds = 64});
        const Light shared = find_light(device, scene, {.seeds = 64});
        EXPECT_LT(Light::variance(shared.direct, shared.direct_square),
                  0.7 * Light::variance(own.direct, own.direct_square));
    });
}

TEST_F(SharedSkyTest, IsLessNoiseThanOwnRays) {
    on_each_device([](Device& device) {
        const Scene dull = room_with_windows(lambertian({0.5f, 0.5f, 0.5f}));
        const Light own = find_light(device, dull, {.shared = false, .seeds = 64});
        const Light shared = find_light(device, dull, {.seeds = 64});
        EXPECT_LT(Light::variance(shared.direct, shared.direct_square),
                  0.3 * Light::variance(own.direct, own.direct_square));
    });
}

TEST_F(SharedSkyTest, IsLessNoiseThanOwnRaysOfCoats) {
    on_each_device([](Device& device) {
        const Scene scene = coated_room();
        const Light own = find_light(device, scene, {.shared = false, .seeds = 64});
        const Light shared = find_light(device, scene, {.seeds = 64});
        EXPECT_LT(Light::variance(shared.emitted, shared.emitted_square),
                  0.6 * Light::variance(own.emitted, own.emitted_square));
    });
}

TEST_F(SharedSkyTest, ADarkSkyBringsNothing) {
    on_each_device([](Device& device) {
        Scene scene = room_with_windows(lambertian({0.5f, 0.5f, 0.5f}));
        std::ranges::fill(scene.environment.radiance, Vec3{0, 0, 0});
        EXPECT_EQ(Light::mean(find_light(device, scene, {}).direct), 0.0);
    });
}

}  // namespace
}  // namespace nearlight::core
