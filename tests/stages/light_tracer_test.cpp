// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_tracer.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "host/stages/joint_programs.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class LightTracerTest : public test::DeviceTest {};

/// No close range, or the close range of a camera with every triangle selected.
CloseRegion make_region(Device& device, const DeviceScene& scene, const CloseRange& range, uint selected) {
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&range, 1));
    region.triangles = Buffer<uint>(device, std::vector<uint>(scene.host_info.triangle_count, selected));
    return region;
}

std::vector<Vpl> trace_all(Device& device, const Scene& scene, const LightWalks& walks) {
    const SceneOnDevice on_device(device, scene);
    return LightTracer(device).run(on_device.buffers, make_region(device, on_device.buffers, {}, 0),
                                   KeepDeposits::all, walks);
}

/// Power of the deposits of each depth, W; entry 0 is depth 1.
struct Power {
    double x = 0, y = 0, z = 0;
};
std::vector<Power> power_by_depth(const std::vector<Vpl>& vpls, uint depths) {
    std::vector<Power> power(depths);
    for (const Vpl& vpl : vpls) {
        Power& sum = power.at(vpl.depth - 1);
        sum.x += vpl.power.x;
        sum.y += vpl.power.y;
        sum.z += vpl.power.z;
    }
    return power;
}

/// In a closed sphere no walk is lost, so the power of depth d is Φ·ρ^d, except that the number of walks that
/// continue is rounded.
TEST_F(LightTracerTest, ClosedFurnaceKeepsItsPowerAtEveryDepth) {
    const Vec3 albedo{0.9f, 0.6f, 0.3f};
    Scene scene;
    add_inward_sphere(scene, 1.0f, 2, add_material(scene, lambertian(albedo)));
    add_point_light(scene, {0.2f, 0.1f, -0.3f}, {1, 2, 3});
    on_each_ray_tree([&](Device& device) {
        for (const float mean_albedo : {0.3f, 0.6f, 0.9f}) {
            const LightWalks walks{
                .walk_count = 20'000, .bounce_count = 5, .mean_albedo = mean_albedo, .seed = 4};
            const std::vector<Power> power =
                power_by_depth(trace_all(device, scene, walks), walks.bounce_count);
            Vec3 expected = Vec3{1, 2, 3} * (4 * kPi);
            float launched = 20'000;
            for (uint depth = 1; depth <= walks.bounce_count; ++depth) {
                expected *= albedo;
                const float tolerance = 1.5f / launched + 1e-4f;
                EXPECT_NEAR(power[depth - 1].x, expected.x, tolerance * expected.x) << "depth " << depth;
                EXPECT_NEAR(power[depth - 1].y, expected.y, tolerance * expected.y) << "depth " << depth;
                EXPECT_NEAR(power[depth - 1].z, expected.z, tolerance * expected.z) << "depth " << depth;
                launched *= mean_albedo;
            }
        }
    });
}

/// VPLs lie on the sphere, just inside, and face its centre.
TEST_F(LightTracerTest, DepositsStandOffTheSurfaceTheyLieOn) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 3, add_material(scene, lambertian({0.8f, 0.8f, 0.8f})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls =
            trace_all(device, scene, {.walk_count = 2000, .bounce_count = 3, .mean_albedo = 0.8f, .seed = 5});
        Vec3 mean{0, 0, 0};
        for (const Vpl& vpl : vpls) {
            ASSERT_NEAR(length(vpl.position), 0.995f, 0.005f);
            ASSERT_NEAR(length(vpl.normal), 1.0f, 1e-5f);
            ASSERT_LT(dot(normalize(vpl.position), vpl.normal), -0.97f);
            mean += vpl.position / static_cast<float>(vpls.size());
        }
        EXPECT_GT(vpls.size(), 4000u);
        EXPECT_LT(length(mean), 0.05f);
    });
}

/// First deposits in a closed white sphere carry all that the light emits.
Power emitted_powers(Device& device, Scene scene) {
    scene.materials.resize(std::max<std::size_t>(scene.materials.size(), 1));
    add_inward_sphere(scene, 3.0f, 2, add_material(scene, lambertian({1, 1, 1})));
    const auto vpls =
        trace_all(device, scene, {.walk_count = 30'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 6});
    return power_by_depth(vpls, 1)[0];
}
double emitted_power(Device& device, const Scene& scene) {
    return emitted_powers(device, scene).y;
}

TEST_F(LightTracerTest, EachOfSeveralLightsEmitsItsOwnPower) {
    Scene scene;
    add_point_light(scene, {0.3f, 0, 0}, {1, 0, 0});
    add_point_light(scene, {0, 0.3f, 0}, {0, 3, 0});
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{0, 0, 800});
    add_quad(scene, {0, 0, -2}, {0.1f, 0, 0}, {0, 0.1f, 0}, add_material(scene, lamp));  // hides very little
    on_each_ray_tree([&](Device& device) {
        const Power powers = emitted_powers(device, scene);
        EXPECT_NEAR(powers.x, 4 * kPi * 1, 0.02 * 4 * kPi);
        EXPECT_NEAR(powers.y, 4 * kPi * 3, 0.02 * 12 * kPi);
        EXPECT_NEAR(powers.z, kPi * 8, 0.02 * 8 * kPi);
    });
}

TEST_F(LightTracerTest, SpotAndAreaLightsEmitTheirPower) {
    on_each_ray_tree([](Device& device) {
        Scene spot;
        add_point_light(spot, {0.3f, 0, 0}, {2, 2, 2});
        spot.delta_emitters[0].type = NEARLIGHT_EMITTER_SPOT;
        spot.delta_emitters[0].direction = normalize(Vec3{1, 2, 3});
        spot.delta_emitters[0].beam_angle = degrees_to_radians(30);
        spot.delta_emitters[0].cutoff_angle = degrees_to_radians(60);
        // ∫ sinθ up to 30°, then ∫ (60° − θ)/30°·sinθ: 2π·(1 − (sin 60° − sin 30°)/(π/6)).
        const double cone = 2 * kPi * (1 - (std::sin(kPi / 3) - 0.5) / (kPi / 6));
        EXPECT_NEAR(emitted_power(device, spot), 2 * cone, 0.005 * cone);

        // Of the bitmap's green channel (0, 255, 64, 128), the mean is that of the linear values.
        Scene projector;
        add_projector(projector, {0, 0.5f, 0}, {1, 2, 3}, 0.5f, 0.25f, {1, 4, 1},
                      add_small_bitmap(projector));
        const double mean = (0 + 1 + 0.0512695 + 0.2158605) / 4;
        EXPECT_NEAR(emitted_power(device, projector), 4 * 0.5 * mean, 0.005 * mean);

        Scene lamp;
        Material emissive = lambertian({0, 0, 0});
        emissive.emission = parameter_of(Vec3{4, 4, 4});
        add_quad(lamp, {-0.2f, 0, 0}, {0.4f, 0, 0}, {0, 0, 0.5f}, add_material(lamp, emissive));
        EXPECT_NEAR(emitted_power(device, lamp), kPi * 4 * 0.2, 0.001 * kPi);
    });
}

/// A square lamp with a bitmap, which lies so close to a white square that its picture is printed there.
TEST_F(LightTracerTest, ATexturedLampEmitsEachTexelAtItsPlace) {
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambertian({1, 1, 1})));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = {Vec3{1, 1, 1}, add_small_bitmap(scene)};
    add_quad(scene, {0, 0, 1e-3f}, {0, 1, 0}, {1, 0, 0}, add_material(scene, lamp));
    for (std::size_t i = 4; i < 8; ++i) {
        scene.vertices[i].u = scene.vertices[i].position.x;
        scene.vertices[i].v = scene.vertices[i].position.y;
    }
    // Between the texels' centres the bitmap is interpolated, and it repeats, so that three quarters of what
    // half a side shows are its own texel's.
    const double green[2][2] = {{0, 1}, {0.0512695, 0.2158605}};  // rows from the top
    on_each_ray_tree([&](Device& device) {
        double power[2][2] = {};
        for (const Vpl& vpl : trace_all(
                 device, scene, {.walk_count = 100'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 7})) {
            power[vpl.position.y < 0.5f ? 1 : 0][vpl.position.x < 0.5f ? 0 : 1] += vpl.power.y;
        }
        for (int row = 0; row < 2; ++row) {
            for (int column = 0; column < 2; ++column) {
                const double mean =
                    0.75 * (0.75 * green[row][column] + 0.25 * green[row][1 - column]) +
                    0.25 * (0.75 * green[1 - row][column] + 0.25 * green[1 - row][1 - column]);
                EXPECT_NEAR(power[row][column], kPi / 4 * mean, 0.01) << row << ", " << column;
            }
        }
    });
}

TEST_F(LightTracerTest, AProjectorFillsItsImagePlaneEvenly) {
    Scene scene;
    add_quad(scene, {-3, -3, 1}, {0, 6, 0}, {6, 0, 0}, add_material(scene, lambertian({1, 1, 1})));
    add_projector(scene, {0, 0, 0}, {0, 0, 1}, 0.6f, 0.3f, {1, 1, 1}, -1);
    const auto [x_axis, y_axis] = orthonormal_basis(Vec3{0, 0, 1});
    on_each_ray_tree([&](Device& device) {
        const auto vpls = trace_all(
            device, scene, {.walk_count = 20'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 7});
        ASSERT_EQ(vpls.size(), 20'000u);
        double x_squared = 0;
        double y_squared = 0;
        for (const Vpl& vpl : vpls) {
            const float x = dot(vpl.position, x_axis) / 0.6f;
            const float y = dot(vpl.position, y_axis) / 0.3f;
            ASSERT_LT(std::max(std::abs(x), std::abs(y)), 1.001f);
            x_squared += x * x / 20'000;
            y_squared += y * y / 20'000;
        }
        EXPECT_NEAR(x_squared, 1.0 / 3, 0.005);
        EXPECT_NEAR(y_squared, 1.0 / 3, 0.005);
    });
}

/// A white square of area A under a sky of radiance L on both sides: each side reflects π·L·A.
TEST_F(LightTracerTest, SkyLightsBothSidesOfASquare) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 3, 0}, add_two_sided(scene, lambertian({1, 1, 1})));
    scene.environment = {.width = 2, .height = 1, .radiance = {{3, 2, 1}, {3, 2, 1}}, .to_world = {}};
    on_each_ray_tree([&](Device& device) {
        const auto vpls = trace_all(
            device, scene, {.walk_count = 100'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 7});
        double up = 0;
        double down = 0;
        for (const Vpl& vpl : vpls) {
            (vpl.normal.z > 0 ? up : down) += vpl.power.y;
        }
        EXPECT_NEAR(up, kPi * 2 * 6, 0.02 * kPi * 12);
        EXPECT_NEAR(down, kPi * 2 * 6, 0.02 * kPi * 12);
    });
}

TEST_F(LightTracerTest, DirectionalLightIsWhatMeetsASquare) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 3, 0}, add_material(scene, lambertian({1, 1, 1})));
    add_directional_light(scene, {3, 0, -4}, {1, 5, 2});
    on_each_ray_tree([&](Device& device) {
        double power = 0;
        for (const Vpl& vpl : trace_all(
                 device, scene, {.walk_count = 100'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 7})) {
            power += vpl.power.y;
        }
        EXPECT_NEAR(power, 5 * 6 * 0.8, 0.01 * 5 * 6);
    });
}

TEST_F(LightTracerTest, SunIsWhatMeetsASquare) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 3, 0}, add_material(scene, lambertian({1, 1, 1})));
    scene.environment = {.width = 1,
                         .height = 1,
                         .radiance = {{0, 0, 0}},
                         .to_world = {},
                         .sun_direction = normalize(Vec3{-3, 0, 4}),
                         .sun_half_angle = 0.01f,
                         .sun_radiance = {1000, 5000, 2000}};
    on_each_ray_tree([&](Device& device) {
        double power = 0;
        for (const Vpl& vpl : trace_all(
                 device, scene, {.walk_count = 100'000, .bounce_count = 1, .mean_albedo = 0.5f, .seed = 7})) {
            power += vpl.power.y;
        }
        const double irradiance = 5000 * std::numbers::pi * 1e-4;
        EXPECT_NEAR(power, irradiance * 6 * 0.8, 0.01 * irradiance * 6);
    });
}

bool same_deposit(const Vpl& a, const Vpl& b) {
    return std::memcmp(&a.position, &b.position, sizeof(Vec3)) == 0 && a.depth == b.depth &&
           std::memcmp(&a.power, &b.power, sizeof(Vec3)) == 0;
}

/// A plain of 200 × 200 under a sky, a sun and a directional light. What each square metre receives is known.
Scene wide_plain() {
    Scene scene;
    add_quad(scene, {-100, 0, -100}, {0, 0, 200}, {200, 0, 0},
             add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    scene.environment = {.width = 1,
                         .height = 1,
                         .radiance = {{1, 1, 1}},
                         .to_world = {},
                         .sun_direction = normalize(Vec3{3, 4, 0}),
                         .sun_half_angle = 0.02f,
                         .sun_radiance = {3000, 3000, 3000}};
    add_directional_light(scene, {0, -3, 4}, {4, 4, 4});
    return scene;
}
const double kPlainIrradiance = kPi + 0.8 * 3000 * kPi * 4e-4 + 0.6 * 4;

double power_within(const std::vector<Vpl>& vpls, Vec3 center, float inner, float outer) {
    double sum = 0;
    for (const Vpl& vpl : vpls) {
        const float distance = length(vpl.position - center);
        sum += distance >= inner && distance < outer ? vpl.power.y : 0.0f;
    }
    return sum;
}

/// Walks that aim bring the same light to every place, and more walks to the place at which they aim.
TEST_F(LightTracerTest, AimedWalksBringTheSameLightEverywhere) {
    const Vec3 center{20, 0, -30};
    const LightWalks walks{
        .walk_count = 200'000, .bounce_count = 1, .seed = 10, .aim = {.center = center, .radius = 30.0f}};
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = trace_all(device, wide_plain(), walks);
        const auto expect_all = [&](float inner, float outer, double tolerance) {
            const double expected = 0.5 * kPlainIrradiance * kPi * (outer * outer - inner * inner);
            EXPECT_NEAR(power_within(vpls, center, inner, outer), expected, tolerance * expected)
                << "from " << inner << " to " << outer;
        };
        expect_all(0, 10, 0.02);
        expect_all(10, 25, 0.01);
        expect_all(25, 35, 0.02);  // aimed walks from the horizon land here too
        expect_all(35, 70, 0.02);
        const LightWalks spread{.walk_count = walks.walk_count, .bounce_count = 1, .seed = 10};
        const auto hits = [&](const std::vector<Vpl>& deposits) {
            return std::ranges::count_if(
                deposits, [&](const Vpl& vpl) { return length(vpl.position - center) < 30.0f; });
        };
        EXPECT_GT(hits(vpls), 6 * hits(trace_all(device, wide_plain(), spread)));
    });
}

/// Where the sphere is about as large as the scene, or there is none, all walks are spread over the scene.
TEST_F(LightTracerTest, NoWalkAimsAtMostOfTheScene) {
    on_each_ray_tree([&](Device& device) {
        LightWalks walks{.walk_count = 20'000, .bounce_count = 1, .seed = 10};
        const std::vector<Vpl> spread = trace_all(device, wide_plain(), walks);
        walks.aim = {.center = {20, 0, -30}, .radius = 0.51f * 100.0f * std::sqrt(2.0f)};
        const std::vector<Vpl> wide = trace_all(device, wide_plain(), walks);
        ASSERT_EQ(wide.size(), spread.size());
        for (std::size_t i = 0; i < wide.size(); ++i) {
            ASSERT_TRUE(same_deposit(wide[i], spread[i])) << i;
        }
    });
}

TEST_F(LightTracerTest, BacksOfOneSidedSurfacesSwallowLight) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambertian({1, 1, 1})));
    add_point_light(scene, {0, 0, -1}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        EXPECT_TRUE(trace_all(device, scene, {.walk_count = 1000, .bounce_count = 2, .seed = 8}).empty());
    });
}

/// The VPLs of `all` that are not in `kept`. The test fails unless `kept` is a subsequence of `all`.
std::vector<Vpl> dropped_from(const std::vector<Vpl>& all, const std::vector<Vpl>& kept) {
    std::vector<Vpl> dropped;
    std::size_t next = 0;
    for (const Vpl& vpl : all) {
        if (next < kept.size() && same_deposit(vpl, kept[next])) {
            ++next;
        } else {
            dropped.push_back(vpl);
        }
    }
    EXPECT_EQ(next, kept.size()) << "something was kept that is not among all deposits";
    return dropped;
}

/// Each policy drops exactly the deposits that it should.
TEST_F(LightTracerTest, KeepModesPartitionAllDeposits) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 2, add_material(scene, lambertian({0.7f, 0.7f, 0.7f})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 90);
    const CloseRange range = make_close_range(make_camera(scene.camera, 64, 64), 5.0f);
    // On the sphere of radius 1 the region is where |x| < z and |y| < z.
    const auto is_inside = [](const Vpl& v, float slack) {
        return std::max(std::abs(v.position.x), std::abs(v.position.y)) < v.position.z + slack;
    };
    constexpr float kStandOff = 1e-4f;
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, scene);
        const CloseRegion region = make_region(device, on_device.buffers, range, 1);
        const LightWalks walks{.walk_count = 5000, .bounce_count = 4, .mean_albedo = 0.7f, .seed = 9};
        LightTracer tracer(device);
        const auto run = [&](KeepDeposits keep) {
            return tracer.run(on_device.buffers, region, keep, walks);
        };
        const std::vector<Vpl> all = run(KeepDeposits::all);
        const std::vector<Vpl> partition = run(KeepDeposits::indirect_inside);
        const std::vector<Vpl> outside = run(KeepDeposits::outside);
        std::size_t direct_inside = 0;
        for (const Vpl& vpl : dropped_from(all, partition)) {
            EXPECT_EQ(vpl.depth, 1u);
            EXPECT_TRUE(is_inside(vpl, kStandOff));
            ++direct_inside;
        }
        EXPECT_NEAR(static_cast<double>(direct_inside), 5000.0 / 6,
                    150);  // the part of the sphere that a cube's side covers
        for (const Vpl& vpl : dropped_from(partition, outside)) {
            EXPECT_GE(vpl.depth, 2u);
            EXPECT_TRUE(is_inside(vpl, kStandOff));
            EXPECT_EQ(vpl.flags, NEARLIGHT_VPL_CLOSE);
        }
        for (const Vpl& vpl : outside) {
            EXPECT_FALSE(is_inside(vpl, -kStandOff));
            EXPECT_EQ(vpl.flags, 0u);
        }
        EXPECT_GT(partition.size(), outside.size() + 500);
        // Triangles that were not selected are not in the close range.
        EXPECT_EQ(tracer
                      .run(on_device.buffers, make_region(device, on_device.buffers, range, 0),
                           KeepDeposits::outside, walks)
                      .size(),
                  all.size());
    });
}

/// One launch of all walks gives the same as launches of parts of them.
TEST_F(LightTracerTest, BatchesDoNotChangeABit) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 2, add_material(scene, lambertian({0.7f, 0.7f, 0.7f})));
    add_point_light(scene, {0.1f, 0.2f, 0.3f}, {1, 1, 1});
    constexpr uint kWalks = 1000;
    constexpr uint kBounces = 3;
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, scene);
        const CloseRegion region = make_region(device, on_device.buffers, {}, 0);
        const Buffer<float> walks_at_depth(device, std::vector<float>{1000.0f, 700.5f, 490.25f});
        const Program program(device, "light_tracer.cl", kWalksProgram);
        Kernel kernel(program, "light_tracer");
        const auto run = [&](uint first, uint count) {
            Buffer<Vpl> vpls(device, std::size_t{count} * kBounces);
            Buffer<uint> flags(device, std::size_t{count} * kBounces);
            vpls.fill_zero();
            kernel.launch_items(count, on_device.buffers, region.range, region.triangles, 0u,
                                static_cast<uint>(KeepDeposits::all), first, count, kBounces, walks_at_depth,
                                0.25f, WalkAim{}, 11u, vpls, flags);
            return std::pair{vpls.download(), flags.download()};
        };
        const auto [vpls, flags] = run(0, kWalks);
        EXPECT_EQ(std::accumulate(flags.begin(), flags.end(), 0u), 1000u + 701u + 490u);
        for (const auto& [first, count] : {std::pair{0u, 333u}, {333u, 1u}, {334u, 666u}}) {
            const auto [part, part_flags] = run(first, count);
            EXPECT_EQ(std::memcmp(part.data(), vpls.data() + first * kBounces, part.size() * sizeof(Vpl)), 0);
            EXPECT_EQ(
                std::memcmp(part_flags.data(), flags.data() + first * kBounces, part.size() * sizeof(uint)),
                0);
        }
    });
}

TEST_F(LightTracerTest, NothingToDoGivesNothing) {
    Scene dark;
    add_inward_sphere(dark, 1.0f, 0, add_material(dark, lambertian({0.7f, 0.7f, 0.7f})));
    Scene lit = dark;
    add_point_light(lit, {0, 0, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        EXPECT_TRUE(trace_all(device, dark, {.walk_count = 100, .bounce_count = 2}).empty());
        EXPECT_TRUE(trace_all(device, lit, {.walk_count = 100, .bounce_count = 0}).empty());
        EXPECT_TRUE(trace_all(device, lit, {.walk_count = 0, .bounce_count = 2}).empty());
    });
}

}  // namespace
}  // namespace nearlight::core
