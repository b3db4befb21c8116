// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>

#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/stages/traced_walks.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::make_region;
using test::Power;
using test::power_by_depth;
using test::same_deposit;
using test::SceneOnDevice;
using test::trace_all;

class LightTracerTest : public test::DeviceTest {};

/// In a closed sphere no walk is lost, so the power of depth d is Φ·ρ^d, except that the number of walks that
/// continue is rounded.
TEST_F(LightTracerTest, ClosedFurnaceKeepsItsPowerAtEveryDepth) {
    const Vec3 albedo{0.9f, 0.6f, 0.3f};
    Scene scene;
    add_inward_sphere(scene, 1.0f, 2, add_material(scene, lambertian(albedo)));
    add_point_light(scene, {0.2f, 0.1f, -0.3f}, {1, 2, 3});
    on_each_ray_tree([&](Device& device) {
        for (const float survival : {0.3f, 0.6f, 0.9f}) {
            const LightWalks walks{.walk_count = 20'000,
                                   .bounce_count = 5,
                                   .min_survival = survival,
                                   .max_survival = survival,
                                   .seed = 4};
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
                launched *= survival;
            }
        }
    });
}

/// In a sphere all places get the same light from all others, so the power of depth d is Φ·ρ^d, with the mean
/// albedo ρ. No VPL is stronger than those of the brighter surface at depth 1, however often it was
/// reflected.
TEST_F(LightTracerTest, AbsorptionFollowsTheSurface) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 3, add_material(scene, lambertian({0.9f, 0.9f, 0.9f})));
    const uint dark = add_material(scene, lambertian({0.3f, 0.3f, 0.3f}));
    for (std::size_t i = 0; i < scene.triangles.size(); i += 2) {
        scene.triangles[i].material = dark;
    }
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const LightWalks walks{.walk_count = 60'000, .bounce_count = 5, .seed = 4};
        const std::vector<Vpl> vpls = trace_all(device, scene, walks);
        const std::vector<Power> power = power_by_depth(vpls, walks.bounce_count);
        double expected = 4 * kPi;
        for (const Power& at_depth : power) {
            expected *= 0.6;
            EXPECT_NEAR(at_depth.x, expected, 0.015 * expected);
        }
        const float strongest = std::ranges::max(vpls, {}, [](const Vpl& v) { return v.power.x; }).power.x;
        EXPECT_LT(strongest, 1.001f * 0.9f * 4 * kPi / static_cast<float>(walks.walk_count));
    });
}

/// VPLs lie on the sphere, just inside, and face its centre.
TEST_F(LightTracerTest, DepositsStandOffTheSurfaceTheyLieOn) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 3, add_material(scene, lambertian({0.8f, 0.8f, 0.8f})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = trace_all(
            device, scene,
            {.walk_count = 2000, .bounce_count = 3, .min_survival = 0.8f, .max_survival = 0.8f, .seed = 5});
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
    Scene floor;
    add_quad(floor, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(floor, lambertian({1, 1, 1})));
    add_point_light(floor, {0, 0, 1}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        for (const Vpl& vpl : trace_all(device, floor, {.walk_count = 100, .bounce_count = 1, .seed = 5})) {
            ASSERT_GT(vpl.position.z, 0.0f);
        }
    });
}

/// A surface of a sphere sends light evenly to the whole sphere. So where a walk lands says nothing of where
/// it came from, unless it takes the same random numbers at each bounce. On average over a sphere, z and x
/// are 0, and their squares ⅓.
TEST_F(LightTracerTest, EachBounceHasRandomNumbersOfItsOwn) {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 4, add_material(scene, lambertian({0.8f, 0.8f, 0.8f})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    scene.delta_emitters[0].type = NEARLIGHT_EMITTER_SPOT;
    scene.delta_emitters[0].direction = {0, 0, 1};
    scene.delta_emitters[0].beam_angle = scene.delta_emitters[0].cutoff_angle = 0.1f;
    on_each_ray_tree([&](Device& device) {
        constexpr uint kDepths = 4;
        std::array<std::vector<Vec3>, kDepths> places;
        const LightWalks walks{.walk_count = 20'000, .bounce_count = kDepths, .seed = 5};
        for (const Vpl& vpl : trace_all(device, scene, walks)) {
            places.at(vpl.depth - 1).push_back(vpl.position);
        }
        const auto mean = [](std::span<const Vec3> at, auto&& f) {
            double sum = 0;
            std::ranges::for_each(at, [&](const Vec3& p) { sum += f(p); });
            return sum / static_cast<double>(at.size());
        };
        EXPECT_GT(mean(places[0], [](const Vec3& p) { return p.z; }), 0.99);
        for (const std::vector<Vec3>& at : std::span(places).subspan(1)) {
            EXPECT_NEAR(mean(at, [](const Vec3& p) { return p.z; }), 0.0, 0.03);
            EXPECT_NEAR(mean(at, [](const Vec3& p) { return p.x; }), 0.0, 0.03);
            EXPECT_NEAR(mean(at, [](const Vec3& p) { return p.z * p.z; }), 1.0 / 3, 0.02);
            EXPECT_NEAR(mean(at, [](const Vec3& p) { return p.x * p.x; }), 1.0 / 3, 0.02);
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
        const LightWalks walks{
            .walk_count = 5000, .bounce_count = 4, .min_survival = 0.7f, .max_survival = 0.7f, .seed = 9};
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
        const Program program(device, "light_tracer.cl");
        Kernel kernel(program, "light_tracer");
        const auto run = [&](uint first, uint count) {
            Buffer<Vpl> vpls(device, std::size_t{count} * kBounces);
            Buffer<uint> counts(device, count);
            vpls.fill_zero();
            const LightTracerParams params{.whole_triangles = 0,
                                           .keep = NEARLIGHT_KEEP_ALL,
                                           .first_walk = first,
                                           .walk_count = count,
                                           .bounce_count = kBounces,
                                           .all_walks = kWalks,
                                           .min_survival = 0.7001f,
                                           .max_survival = 0.7001f,
                                           .absorption_shift = 0.25f,
                                           .seed = 11,
                                           .pad0 = 0,
                                           .pad1 = 0};
            kernel.launch_items(count, on_device.buffers, region.range, region.triangles, params, WalkAim{},
                                vpls, counts);
            return std::pair{vpls.download(), counts.download()};
        };
        const auto [vpls, counts] = run(0, kWalks);
        EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0u), 1000u + 700u + 490u);
        for (const auto& [first, count] : {std::pair{0u, 333u}, {333u, 1u}, {334u, 666u}}) {
            const auto [part, part_counts] = run(first, count);
            EXPECT_EQ(std::memcmp(part.data(), vpls.data() + first * kBounces, part.size() * sizeof(Vpl)), 0);
            EXPECT_TRUE(std::ranges::equal(part_counts, std::span(counts).subspan(first, count)));
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
