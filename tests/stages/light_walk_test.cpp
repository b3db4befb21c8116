// SPDX-License-Identifier: Apache-2.0
// Walks over surfaces that are not Lambertian: mirrors, panes of glass and coats.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "host/scene/material_model.h"
#include "host/stages/light_tracer.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class LightWalkTest : public test::DeviceTest {};

constexpr float kGrey = 0.5f;
constexpr float kLampSide = 0.02f;
constexpr float kLampRadiance = 8.0f;

/// A small lamp at the origin that shines towards +Z.
void add_small_lamp(Scene& scene) {
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{kLampRadiance, kLampRadiance, kLampRadiance});
    constexpr float kHalf = kLampSide / 2;
    add_quad(scene, {-kHalf, -kHalf, 0}, {kLampSide, 0, 0}, {0, kLampSide, 0}, add_material(scene, lamp));
}

/// A square of 2 × 2 about (2, 0, z), whose front is on the side of the plane z = 0.
void add_screen(Scene& scene, float z, const Material& material) {
    const Vec3 x{2, 0, 0};
    const Vec3 y{0, 2, 0};
    add_quad(scene, {1, -1, z}, z < 0 ? x : y, z < 0 ? y : x, add_material(scene, material));
}

/// ∫ cosθ/r² · f(cosθ) dA over such a square, seen from a point at the distance `height`.
double over_screen(double height, const std::function<double(double)>& f) {
    constexpr int kSteps = 200;
    constexpr double kStep = 2.0 / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double x = 1 + (i + 0.5) * kStep;
            const double y = -1 + (j + 0.5) * kStep;
            const double squared = x * x + y * y + height * height;
            const double cosine = height / std::sqrt(squared);
            sum += cosine / squared * f(cosine) * kStep * kStep;
        }
    }
    return sum;
}

/// What the lamp sends to the square at a distance, if `f` of it comes through.
double lamp_flux(double height, const std::function<double(double)>& f) {
    return double{kLampRadiance} * kLampSide * kLampSide *
           over_screen(height, [&](double cosine) { return cosine * f(cosine); });
}

std::vector<Vpl> walk(Device& device, const Scene& scene, uint walk_count = 400'000, uint bounce_count = 2) {
    const test::SceneOnDevice on_device(device, scene);
    const CloseRange nothing{};
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&nothing, 1));
    region.triangles = Buffer<uint>(device, std::vector<uint>(scene.triangles.size()));
    return LightTracer(device).run(on_device.buffers, region, KeepDeposits::all,
                                   {.walk_count = walk_count,
                                    .bounce_count = bounce_count,
                                    .min_survival = 1.0f,
                                    .max_survival = 1.0f,
                                    .seed = 12});
}

double power_at_depth(const std::vector<Vpl>& vpls, uint depth) {
    double sum = 0;
    for (const Vpl& vpl : vpls) {
        sum += vpl.depth == depth ? vpl.power.y : 0.0f;
    }
    return sum;
}

/// A mirror above the lamp and the screen. Its colour differs from channel to channel.
Scene below_a_mirror(float alpha) {
    Scene scene;
    Material mirror = conductor_material({0, 0, 0}, {1, 1, 1}, {1, 0.75f, 0.5f});
    mirror.roughness = parameter_of(alpha);
    add_quad(scene, {-20, -20, 1}, {0, 40, 0}, {40, 0, 0}, add_material(scene, mirror));
    add_screen(scene, -1, lambertian({kGrey, kGrey, kGrey}));
    return scene;
}

TEST_F(LightWalkTest, MirrorsSendOnTheLightOfLamps) {
    Scene scene = below_a_mirror(0);
    add_small_lamp(scene);
    // The lamp's image is at the height 2.
    const double expected = kGrey * 0.75 * lamp_flux(3, [](double) { return 1.0; });
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = walk(device, scene);
        EXPECT_EQ(power_at_depth(vpls, 1), 0.0) << "a mirror holds no VPLs";
        EXPECT_NEAR(power_at_depth(vpls, 2), expected, 0.015 * expected);
        for (const Vpl& vpl : vpls) {
            ASSERT_NEAR(vpl.power.x * 0.5f, vpl.power.z, 1e-5f * vpl.power.x);
            ASSERT_EQ(vpl.normal.z, 1.0f);
        }
    });
}

/// No path from the camera finds a point light in a mirror, but one by way of a rough metal does.
TEST_F(LightWalkTest, LightOfPointsEndsAtMirrorsButNotAtRoughMetal) {
    const double direct = kGrey * over_screen(1, [](double) { return 1.0; });
    on_each_ray_tree([&](Device& device) {
        for (const float alpha : {0.0f, 0.3f}) {
            Scene scene = below_a_mirror(alpha);
            add_point_light(scene, {0, 0, 0}, {1, 1, 1});
            const std::vector<Vpl> vpls = walk(device, scene);
            EXPECT_NEAR(power_at_depth(vpls, 1), direct, 0.015 * direct);
            const double by_metal = power_at_depth(vpls, 2);
            if (alpha == 0) {
                EXPECT_EQ(by_metal, 0.0);
            } else {
                EXPECT_GT(by_metal, 0.3 * kGrey * 0.75 * over_screen(3, [](double) { return 1.0; }));
            }
        }
    });
}

TEST_F(LightWalkTest, PanesOfGlassLetTheLightOfLampsThrough) {
    Scene scene;
    add_small_lamp(scene);
    add_quad(scene, {-20, -20, 1}, {0, 40, 0}, {40, 0, 0},
             add_material(scene, thin_dielectric_material(1.5)));
    add_screen(scene, 2, lambertian({kGrey, kGrey, kGrey}));
    const double expected = kGrey * lamp_flux(2, [](double cosine) {
                                const double f = dielectric_reflectance(cosine, 1.5);
                                return (1 - f) / (1 + f);  // of both faces, with all inter-reflection
                            });
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = walk(device, scene);
        EXPECT_EQ(power_at_depth(vpls, 1), 0.0);
        EXPECT_NEAR(power_at_depth(vpls, 2), expected, 0.015 * expected);
    });
}

/// A walk turns by other random numbers at each surface: the cosines with which it leaves two in a row
/// differ.
TEST_F(LightWalkTest, EachSurfaceHasRandomNumbersOfItsOwn) {
    Scene scene;
    const uint white = add_material(scene, lambertian({1, 1, 1}));
    add_quad(scene, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0}, white);
    add_quad(scene, {-9, -9, 1}, {0, 18, 0}, {18, 0, 0}, white);
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = walk(device, scene, 300, 3);
        int pairs = 0;
        int equal = 0;
        for (std::size_t i = 0; i + 2 < vpls.size(); ++i) {
            if (vpls[i].depth == 1 && vpls[i + 1].depth == 2 && vpls[i + 2].depth == 3) {
                const float first = std::abs(normalize(vpls[i + 1].position - vpls[i].position).z);
                const float second = std::abs(normalize(vpls[i + 2].position - vpls[i + 1].position).z);
                ++pairs;
                equal += std::abs(first - second) < 1e-3f ? 1 : 0;
            }
        }
        EXPECT_GT(pairs, 50);
        EXPECT_LT(equal, pairs / 10);
    });
}

/// The coat weighs arriving light, and names the curve that weighs what leaves.
TEST_F(LightWalkTest, DepositsBelowCoatsAreWeighedByTheirCurve) {
    Scene scene;
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    Material coated = plastic_material(scene, {.eta = 1.5});
    coated.reflectance = parameter_of(Vec3{kGrey, kGrey, kGrey});
    add_screen(scene, -0.5f, coated);
    const double base = kGrey / (1 - coated.internal_reflectance) / (1.5 * 1.5);
    const double expected =
        over_screen(0.5, [&](double cosine) { return base * (1 - dielectric_reflectance(cosine, 1.5)); });
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = walk(device, scene);
        EXPECT_NEAR(power_at_depth(vpls, 1), expected, 0.015 * expected);
        EXPECT_GT(vpls.size(), 1000u);
        for (const Vpl& vpl : vpls) {
            ASSERT_EQ(vpl.flags >> NEARLIGHT_VPL_CURVE_SHIFT, coated.curve);
        }
        EXPECT_NE(coated.curve, 0u);
    });
}

}  // namespace
}  // namespace nearlight::core
