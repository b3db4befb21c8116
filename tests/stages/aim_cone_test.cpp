// SPDX-License-Identifier: Apache-2.0
// Walks that land far from the sphere at which walks aim, and go on towards it.
#include <algorithm>
#include <cmath>

#include "tests/stages/traced_walks.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::aim_at;
using test::trace_all;

class AimConeTest : public test::DeviceTest {};

constexpr float kPanelHeight = 10.0f;
constexpr float kPanelAlbedo = 0.8f;

/// A square plain about the origin, and above its middle a panel of 2 × 2 that faces it.
Scene panel_above(float half_side, const Material& plain) {
    Scene scene;
    add_quad(scene, {-half_side, 0, -half_side}, {0, 0, 2 * half_side}, {2 * half_side, 0, 0},
             add_material(scene, plain));
    add_quad(scene, {-1, kPanelHeight, -1}, {2, 0, 0}, {0, 0, 2},
             add_material(scene, lambertian({kPanelAlbedo, kPanelAlbedo, kPanelAlbedo})));
    return scene;
}

/// The part of the hemisphere below a point of the panel that the plain fills, by cosine: four times that of
/// a square whose corner is below the point.
double plain_in_view(float half_side) {
    const double a = half_side / kPanelHeight;
    const double root = std::sqrt(1 + a * a);
    return 4 * (2 * a / root * std::atan(a / root)) / (2 * kPi);
}

constexpr float kWideHalfSide = 100.0f;

/// The same on a wide plain in slanting sunlight.
Scene sunlit_panel() {
    Scene scene = panel_above(kWideHalfSide, lambertian({0.5f, 0.5f, 0.5f}));
    add_directional_light(scene, {3, -4, 0}, {10, 10, 10});
    return scene;
}
/// What its panel gets from the plain and reflects, W.
const double kSunlitPower = kPanelAlbedo * 0.5 * 8 * plain_in_view(kWideHalfSide) * 4;

/// Deposits of depth 2 on the panel.
struct OnPanel {
    double power = 0;  // W, for each of the seeds
    double count = 0;
    double strongest = 0;
};

constexpr uint kSeeds = 4;

OnPanel on_panel(Device& device, const Scene& scene, const WalkAim& aim) {
    OnPanel panel;
    for (uint seed = 0; seed < kSeeds; ++seed) {
        const LightWalks walks{.walk_count = 400'000, .bounce_count = 2, .seed = seed, .aim = aim};
        for (const Vpl& vpl : trace_all(device, scene, walks)) {
            if (vpl.depth == 2 && vpl.position.y > 0.5f * kPanelHeight) {
                panel.power += vpl.power.y / kSeeds;
                panel.count += 1;
                panel.strongest = std::max(panel.strongest, static_cast<double>(vpl.power.y));
            }
        }
    }
    return panel;
}

/// The panel gets the same light from a plain whether walks aim at it, past it or not at all, and without
/// VPLs that stand for much of it where they aim.
TEST_F(AimConeTest, FarWalksBringTheSameLightByMoreVpls) {
    const Scene scene = sunlit_panel();
    const double expected = kSunlitPower;
    on_each_ray_tree([&](Device& device) {
        const OnPanel aimed = on_panel(device, scene, aim_at({0, kPanelHeight, 0}, 3.0f));
        EXPECT_NEAR(aimed.power, expected, 0.03 * expected);
        EXPECT_LT(aimed.strongest, 0.004 * expected);
        const OnPanel beside = on_panel(device, scene, aim_at({0, kPanelHeight, 6}, 3.0f));
        EXPECT_NEAR(beside.power, expected, 0.08 * expected);
        const OnPanel spread = on_panel(device, scene, {});
        EXPECT_GT(aimed.count, 20 * spread.count);
        EXPECT_GT(beside.count, 5 * spread.count);
    });
}

/// A sphere about the origin at which no walk aims, with an opening in the panel. Walks reach its outer side
/// from below.
WalkAim opening_in_panel(Vec3 outwards, float radius) {
    return {
        .center = {0, 0, 0},
        .radius = 0.0f,
        .openings = {{.center = {0, kPanelHeight, 0}, .radius = radius, .outwards = outwards, .share = 1}},
        .opening_count = 1};
}

TEST_F(AimConeTest, WalksOutsideAimAtOpenings) {
    const Scene scene = sunlit_panel();
    const double expected = kSunlitPower;
    on_each_ray_tree([&](Device& device) {
        const OnPanel aimed = on_panel(device, scene, opening_in_panel({0, -1, 0}, 1.1f));
        EXPECT_NEAR(aimed.power, expected, 0.03 * expected);
        EXPECT_LT(aimed.strongest, 0.03 * expected);
        EXPECT_GT(aimed.count, 20 * on_panel(device, scene, {}).count);
    });
}

TEST_F(AimConeTest, WalksInsideDoNotAimAtOpenings) {
    Scene scene = panel_above(10.0f, lambertian({0.5f, 0.5f, 0.5f}));
    add_point_light(scene, {0, 5, 0}, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        LightWalks walks{.walk_count = 20'000, .bounce_count = 3, .seed = 4};
        const std::vector<Vpl> spread = trace_all(device, scene, walks);
        walks.aim = opening_in_panel({0, 1, 0}, 1.1f);
        const std::vector<Vpl> inside = trace_all(device, scene, walks);
        EXPECT_TRUE(std::ranges::equal(inside, spread, test::same_deposit));
        walks.aim = opening_in_panel({0, -1, 0}, 1.1f);
        EXPECT_FALSE(std::ranges::equal(trace_all(device, scene, walks), spread, test::same_deposit));
    });
}

/// Several openings share the walks that aim, besides those that aim at the sphere.
TEST_F(AimConeTest, WalksAimAtAllOpenings) {
    const Scene scene = sunlit_panel();
    const double expected = kSunlitPower;
    WalkAim aim = opening_in_panel({0, -1, 0}, 0.6f);
    aim.center = {2, kPanelHeight, 0};
    aim.radius = 3.0f;
    aim.openings[0].share = 0.25f;
    aim.openings[1] = {.center = {0.5f, kPanelHeight, 0.5f},
                       .radius = 0.5f,
                       .outwards = normalize(Vec3{1, -1, 0}),
                       .share = 0.75f};
    aim.opening_count = 2;
    on_each_ray_tree([&](Device& device) {
        const OnPanel aimed = on_panel(device, scene, aim);
        EXPECT_NEAR(aimed.power, expected, 0.03 * expected);
        EXPECT_LT(aimed.strongest, 0.006 * expected);
    });
}

/// A mirror sends light on in one direction only, which no walk can aim.
TEST_F(AimConeTest, WalksDoNotAimOffMirrors) {
    constexpr float kHalfSide = 10.0f;
    Scene scene = panel_above(kHalfSide, conductor_material({0, 0, 0}, {1, 1, 1}, {1, 1, 1}));
    set_constant_sky(scene, {1, 1, 1});
    const double expected = kPanelAlbedo * kPi * plain_in_view(kHalfSide) * 4;
    on_each_ray_tree([&](Device& device) {
        const OnPanel aimed = on_panel(device, scene, aim_at({0, kPanelHeight, 0}, 3.0f));
        EXPECT_NEAR(aimed.power, expected, 0.1 * expected);
    });
}

/// A thick coat mirrors part of the light, and what lies below it scatters the rest.
TEST_F(AimConeTest, CoatsSendOnTheirMirrorImages) {
    Scene scene = panel_above(10.0f, {});
    scene.materials[scene.triangles[0].material] = coated(scene, {0.5f, 0.5f, 0.5f}, {.eta = 2.5});
    set_constant_sky(scene, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const OnPanel aimed = on_panel(device, scene, aim_at({0, kPanelHeight, 0}, 3.0f));
        const OnPanel spread = on_panel(device, scene, {});
        EXPECT_NEAR(aimed.power, spread.power, 0.03 * spread.power);
    });
}

}  // namespace
}  // namespace nearlight::core
