// SPDX-License-Identifier: Apache-2.0
// The light that walks bring from each kind of light: how much, and where to.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/stages/traced_walks.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::Power;
using test::power_by_depth;
using test::same_deposit;
using test::trace_all;

class LightEmissionTest : public test::DeviceTest {};

/// First deposits in a closed white sphere carry all that the light emits.
Power emitted_powers(Device& device, Scene scene) {
    scene.materials.resize(std::max<std::size_t>(scene.materials.size(), 1));
    add_inward_sphere(scene, 3.0f, 2, add_material(scene, lambertian({1, 1, 1})));
    const auto vpls = trace_all(device, scene, {.walk_count = 30'000, .bounce_count = 1, .seed = 6});
    return power_by_depth(vpls, 1)[0];
}
double emitted_power(Device& device, const Scene& scene) {
    return emitted_powers(device, scene).y;
}

TEST_F(LightEmissionTest, EachOfSeveralLightsEmitsItsOwnPower) {
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

TEST_F(LightEmissionTest, SpotAndAreaLightsEmitTheirPower) {
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

/// The cosines of the angles of these spots are 1 but for their last bits, or 1. For small angles,
/// 2π·(1 − (sin c − sin b)/(c − b)) is π/3·(c² + cb + b²).
TEST_F(LightEmissionTest, NarrowSpotsEmitTheirPower) {
    on_each_ray_tree([](Device& device) {
        for (const double cutoff : {1e-2, 1e-3, 1.7e-4}) {
            const double beam = 0.5 * cutoff;
            Scene spot;
            add_point_light(spot, {0.3f, 0, 0}, {2e6f, 2e6f, 2e6f});
            spot.delta_emitters[0].type = NEARLIGHT_EMITTER_SPOT;
            spot.delta_emitters[0].direction = normalize(Vec3{1, 2, 3});
            spot.delta_emitters[0].beam_angle = static_cast<float>(beam);
            spot.delta_emitters[0].cutoff_angle = static_cast<float>(cutoff);
            const double cone = kPi / 3 * (cutoff * cutoff + cutoff * beam + beam * beam);
            EXPECT_NEAR(emitted_power(device, spot), 2e6 * cone, 0.01 * 2e6 * cone) << cutoff;
        }
    });
}

/// A square lamp with a bitmap, which lies so close to a white square that its picture is printed there.
TEST_F(LightEmissionTest, ATexturedLampEmitsEachTexelAtItsPlace) {
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
        for (const Vpl& vpl :
             trace_all(device, scene, {.walk_count = 100'000, .bounce_count = 1, .seed = 7})) {
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

TEST_F(LightEmissionTest, AProjectorFillsItsImagePlaneEvenly) {
    Scene scene;
    add_quad(scene, {-3, -3, 1}, {0, 6, 0}, {6, 0, 0}, add_material(scene, lambertian({1, 1, 1})));
    add_projector(scene, {0, 0, 0}, {0, 0, 1}, 0.6f, 0.3f, {1, 1, 1}, -1);
    const auto [x_axis, y_axis] = orthonormal_basis(Vec3{0, 0, 1});
    on_each_ray_tree([&](Device& device) {
        const auto vpls = trace_all(device, scene, {.walk_count = 20'000, .bounce_count = 1, .seed = 7});
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
TEST_F(LightEmissionTest, SkyLightsBothSidesOfASquare) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 3, 0}, add_two_sided(scene, lambertian({1, 1, 1})));
    scene.environment = {.width = 2, .height = 1, .radiance = {{3, 2, 1}, {3, 2, 1}}, .to_world = {}};
    on_each_ray_tree([&](Device& device) {
        const auto vpls = trace_all(device, scene, {.walk_count = 100'000, .bounce_count = 1, .seed = 7});
        double up = 0;
        double down = 0;
        for (const Vpl& vpl : vpls) {
            (vpl.normal.z > 0 ? up : down) += vpl.power.y;
        }
        EXPECT_NEAR(up, kPi * 2 * 6, 0.02 * kPi * 12);
        EXPECT_NEAR(down, kPi * 2 * 6, 0.02 * kPi * 12);
    });
}

TEST_F(LightEmissionTest, DirectionalLightIsWhatMeetsASquare) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 3, 0}, add_material(scene, lambertian({1, 1, 1})));
    add_directional_light(scene, {3, 0, -4}, {1, 5, 2});
    on_each_ray_tree([&](Device& device) {
        double power = 0;
        for (const Vpl& vpl :
             trace_all(device, scene, {.walk_count = 100'000, .bounce_count = 1, .seed = 7})) {
            power += vpl.power.y;
        }
        EXPECT_NEAR(power, 5 * 6 * 0.8, 0.01 * 5 * 6);
    });
}

TEST_F(LightEmissionTest, SunIsWhatMeetsASquare) {
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
        for (const Vpl& vpl :
             trace_all(device, scene, {.walk_count = 100'000, .bounce_count = 1, .seed = 7})) {
            power += vpl.power.y;
        }
        const double irradiance = 5000 * std::numbers::pi * 1e-4;
        EXPECT_NEAR(power, irradiance * 6 * 0.8, 0.01 * irradiance * 6);
    });
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

/// Expects what the plain reflects, one half of an even irradiance, between two distances from a place.
void expect_even_light(const std::vector<Vpl>& vpls, double irradiance, Vec3 center, float inner, float outer,
                       double tolerance) {
    const double expected = 0.5 * irradiance * kPi * (outer * outer - inner * inner);
    EXPECT_NEAR(power_within(vpls, center, inner, outer), expected, tolerance * expected)
        << "from " << inner << " to " << outer;
}

/// Walks that aim bring the same light to every place, and more walks to the place at which they aim.
TEST_F(LightEmissionTest, AimedWalksBringTheSameLightEverywhere) {
    const Vec3 center{20, 0, -30};
    const LightWalks walks{
        .walk_count = 200'000, .bounce_count = 1, .seed = 10, .aim = test::aim_at(center, 30.0f)};
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = trace_all(device, wide_plain(), walks);
        const auto expect_all = [&](float inner, float outer, double tolerance) {
            expect_even_light(vpls, kPlainIrradiance, center, inner, outer, tolerance);
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

/// A plain of 8 × 8 in the middle of a dome that shines everywhere, and a round lamp far above it. What each
/// square metre receives from the dome is π; the lamp of radiance L and radius r brings π·L·(r/d)²·cosθ.
Scene plain_in_dome() {
    Scene scene;
    add_quad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    Material shining = lambertian({0, 0, 0});
    shining.emission = parameter_of(Vec3{1, 1, 1});
    add_inward_sphere(scene, 60, 2, add_material(scene, shining));
    add_sphere_lamp(scene, {0, 40, 0}, 2, {400, 400, 400});
    return scene;
}
/// The lamp hides (r/d)² of the dome at right angles, where that would have brought π.
const double kDomeIrradiance = kPi + kPi * 399 * (2.0 / 40) * (2.0 / 40);

/// Walks from lamps that are far from what the camera sees aim there, and bring the same light to every
/// place. Over the plain the lamp's light falls by less than a hundredth.
TEST_F(LightEmissionTest, AimedWalksOfFarLampsBringTheSameLightEverywhere) {
    const Vec3 center{1, 0, -1};
    const LightWalks walks{
        .walk_count = 100'000, .bounce_count = 1, .seed = 10, .aim = test::aim_at(center, 2.0f)};
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = trace_all(device, plain_in_dome(), walks);
        const auto expect_all = [&](float inner, float outer, double tolerance) {
            expect_even_light(vpls, kDomeIrradiance, center, inner, outer, tolerance);
        };
        expect_all(0, 1, 0.03);
        expect_all(1, 2, 0.03);
        expect_all(2, 3, 0.03);
        const LightWalks spread{.walk_count = walks.walk_count, .bounce_count = 1, .seed = 10};
        const std::size_t by_chance = trace_all(device, plain_in_dome(), spread).size();
        EXPECT_GT(vpls.size(), 50 * by_chance);
    });
}

/// Walks aim at openings if they come from their outer side.
TEST_F(LightEmissionTest, WalksThroughOpeningsBringTheSameLightEverywhere) {
    LightWalks walks{.walk_count = 200'000, .bounce_count = 1, .seed = 10};
    walks.aim = {.center = {},
                 .radius = 0,
                 .openings = {{.center = {20, 0, -30}, .radius = 10, .outwards = {0, 1, 0}, .share = 0.4f},
                              {.center = {-20, 0, 30}, .radius = 5, .outwards = {0, 1, 0}, .share = 0.4f},
                              {.center = {50, 0, 30}, .radius = 5, .outwards = {0, -1, 0}, .share = 0.2f}},
                 .opening_count = 3};
    on_each_ray_tree([&](Device& device) {
        const std::vector<Vpl> vpls = trace_all(device, wide_plain(), walks);
        const std::vector<Vpl> spread =
            trace_all(device, wide_plain(), {.walk_count = 200'000, .bounce_count = 1, .seed = 10});
        const auto hits = [&](const std::vector<Vpl>& deposits, const Opening& opening) {
            return std::ranges::count_if(deposits, [&](const Vpl& vpl) {
                return length(vpl.position - opening.center) < opening.radius;
            });
        };
        for (const Opening& opening : std::span(walks.aim.openings).first(2)) {
            SCOPED_TRACE("an opening of radius " + std::to_string(opening.radius));
            const auto expect_all = [&](float inner, float outer, double tolerance) {
                expect_even_light(vpls, kPlainIrradiance, opening.center, inner, outer, tolerance);
            };
            expect_all(0, opening.radius, 0.01);
            expect_all(opening.radius, 1.5f * opening.radius, 0.02);
            expect_all(1.5f * opening.radius, 4 * opening.radius, 0.03);
            EXPECT_GT(hits(vpls, opening), 10 * hits(spread, opening));
        }
        EXPECT_LT(hits(vpls, walks.aim.openings[2]), 2 * hits(spread, walks.aim.openings[2]));
    });
}

/// Where the sphere is about as large as the scene, or there is none, all walks are spread over the scene.
TEST_F(LightEmissionTest, NoWalkAimsAtMostOfTheScene) {
    on_each_ray_tree([&](Device& device) {
        LightWalks walks{.walk_count = 20'000, .bounce_count = 1, .seed = 10};
        const std::vector<Vpl> spread = trace_all(device, wide_plain(), walks);
        walks.aim = test::aim_at({20, 0, -30}, 0.51f * 100.0f * std::sqrt(2.0f));
        const std::vector<Vpl> wide = trace_all(device, wide_plain(), walks);
        ASSERT_EQ(wide.size(), spread.size());
        for (std::size_t i = 0; i < wide.size(); ++i) {
            ASSERT_TRUE(same_deposit(wide[i], spread[i])) << i;
        }
    });
}

}  // namespace
}  // namespace nearlight::core
