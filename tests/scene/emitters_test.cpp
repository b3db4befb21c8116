// SPDX-License-Identifier: Apache-2.0
#include "host/scene/emitters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/scene/distribution.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using small_scenes::patterned_map;

constexpr double kPiD = std::numbers::pi;

/// A scene in which triangle 0 emits, triangle 1 emits but has no area, and triangle 2 is dark.
Scene area_light_scene(Vec3 radiance) {
    Scene scene;
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 0, 2}, Vec3{1, 0, 1}}) {
        scene.vertices.push_back({p, 0, {0, 0, 0}, 0});
    }
    scene.materials.resize(2, Material{});
    scene.materials[1].emission = {radiance, -1};
    scene.triangles = {{0, 1, 2, 1}, {0, 1, 1, 1}, {0, 1, 3, 0}};
    return scene;
}

Emitter point_light(Vec3 intensity) {
    Emitter emitter{};
    emitter.type = NEARLIGHT_EMITTER_POINT;
    emitter.radiance = intensity;
    return emitter;
}

Emitter spot_light(float beam, float cutoff) {
    Emitter emitter = point_light({1, 1, 1});
    emitter.type = NEARLIGHT_EMITTER_SPOT;
    emitter.beam_angle = beam;
    emitter.cutoff_angle = cutoff;
    return emitter;
}

TEST(EmitterTable, ADarkSceneHasNone) {
    Scene scene = area_light_scene({0, 0, 0});
    scene.delta_emitters = {point_light({0, 0, 0})};
    scene.environment = patterned_map(2, 2);
    scene.environment.radiance.assign(4, {0, 0, 0});
    const EmitterTable table = build_emitter_table(scene);
    EXPECT_TRUE(table.emitters.empty());
    EXPECT_EQ(table.delta_emitter_count, 0u);
    EXPECT_EQ(table.total_power, 0.0f);
    EXPECT_TRUE(build_emitter_table(Scene{}).emitters.empty());
}

TEST(EmitterTable, PowersAreThoseOfTheFormulae) {
    Scene scene = area_light_scene({3, 2, 1});
    const float area_luminance = luminance({3, 2, 1});
    EXPECT_NEAR(build_emitter_table(scene).total_power, kPiD * 2 * area_luminance, 1e-4);
    scene.materials[1].emission.value = {0, 0, 0};
    scene.delta_emitters = {point_light({1, 1, 1})};
    EXPECT_NEAR(build_emitter_table(scene).total_power, 4 * kPiD, 1e-5);
}

TEST(EmitterTable, PowersOfProjectorsAndDirectionalLights) {
    Scene scene = area_light_scene({0, 0, 0});
    scene.images.push_back({"one bright texel",
                            2,
                            2,
                            NEARLIGHT_TEXELS_SRGB8,
                            {0xff000000u, 0xff000000u, 0xff000000u, 0xffffffffu}});
    scene.textures.resize(1);
    scene.textures[0].image = 0;
    Emitter projector = point_light({3, 3, 3});
    projector.type = NEARLIGHT_EMITTER_PROJECTOR;
    projector.area = 0.5f;
    scene.delta_emitters = {projector};
    EXPECT_NEAR(build_emitter_table(scene).total_power, 1.5, 1e-6);
    scene.delta_emitters[0].image = 1;
    EXPECT_NEAR(build_emitter_table(scene).total_power, 1.5 / 4, 1e-6);
    Emitter sun = point_light({5, 5, 5});
    sun.type = NEARLIGHT_EMITTER_DIRECTIONAL;
    scene.delta_emitters = {sun};
    EXPECT_NEAR(build_emitter_table(scene).total_power, kPiD * 2 * 5, 1e-4);  // a sphere of radius √2
    EXPECT_EQ(build_emitter_table(scene).delta_emitter_count, 1u);
}

TEST(EmitterTable, OrderProbabilitiesAndContents) {
    Scene scene = area_light_scene({1, 1, 1});
    scene.delta_emitters = {point_light({0, 0, 0}), point_light({2, 2, 2}), spot_light(0.2f, 0.4f)};
    scene.environment = patterned_map(4, 2);
    const EmitterTable table = build_emitter_table(scene);
    ASSERT_EQ(table.emitters.size(), 4u);
    EXPECT_EQ(table.delta_emitter_count, 2u);
    EXPECT_EQ(table.emitters[0].type, NEARLIGHT_EMITTER_POINT);
    EXPECT_EQ(table.emitters[1].type, NEARLIGHT_EMITTER_SPOT);
    EXPECT_EQ(table.emitters[2].type, NEARLIGHT_EMITTER_TRIANGLE);
    EXPECT_EQ(table.emitters[2].triangle, 0u);
    EXPECT_FLOAT_EQ(table.emitters[2].area, 2.0f);
    EXPECT_EQ(table.emitters[3].type, NEARLIGHT_EMITTER_ENVIRONMENT);
    EXPECT_EQ(table.emitters[3].cdf, 1.0f);
    Scene spot;
    spot.delta_emitters = {spot_light(0.2f, 0.4f)};
    const double lamps = 8 * kPiD + static_cast<double>(build_emitter_table(spot).total_power);
    EXPECT_NEAR(table.emitters[0].probability, 8 * kPiD / lamps / 3, 1e-6);
    EXPECT_NEAR(table.emitters[2].probability, 1.0 / 3, 1e-6);
    float sum = 0;
    for (const Emitter& emitter : table.emitters) {
        EXPECT_GT(emitter.probability, 0.0f);
        sum += emitter.probability;
        EXPECT_EQ(emitter.cdf, sum);  // exact: all are multiples of 2^-24
    }
}

/// The sky's power grows with the grounds around a house, but the lamps in it are chosen as often as before.
TEST(EmitterTable, EachKindOfLightHasItsPartOfTheChoice) {
    Scene scene = area_light_scene({1, 1, 1});
    scene.vertices.push_back({{10'000, 0, 0}, 0, {0, 0, 0}, 0});
    scene.triangles.push_back({0, 2, 4, 0});
    scene.delta_emitters = {point_light({1, 1, 1}), point_light({3, 3, 3}), point_light({1, 1, 1})};
    scene.delta_emitters[2].type = NEARLIGHT_EMITTER_DIRECTIONAL;
    scene.delta_emitters[2].direction = {0, -1, 0};
    scene.environment = {.width = 1,
                         .height = 1,
                         .radiance = {{1, 1, 1}},
                         .to_world = {},
                         .sun_direction = {0, 1, 0},
                         .sun_half_angle = 0.01f,
                         .sun_radiance = {1000, 1000, 1000}};
    const EmitterTable table = build_emitter_table(scene);
    ASSERT_EQ(table.emitters.size(), 6u);
    EXPECT_EQ(table.emitters[0].type, NEARLIGHT_EMITTER_DIRECTIONAL);
    EXPECT_NEAR(table.emitters[1].probability, 1.0 / 5 / 4, 1e-6);
    EXPECT_NEAR(table.emitters[2].probability, 1.0 / 5 * 3 / 4, 1e-6);
    for (const uint type : {NEARLIGHT_EMITTER_DIRECTIONAL, NEARLIGHT_EMITTER_TRIANGLE, NEARLIGHT_EMITTER_SUN,
                            NEARLIGHT_EMITTER_ENVIRONMENT}) {
        const auto found = std::ranges::find(table.emitters, type, &Emitter::type);
        ASSERT_NE(found, table.emitters.end()) << type;
        EXPECT_NEAR(found->probability, 1.0 / 5, 1e-6) << type;
    }
}

TEST(EmitterTable, SpotPowerIsTheIntegralOfItsFalloff) {
    for (const auto& [beam, cutoff] : {std::pair{0.0f, 0.5f}, {0.3f, 0.35f}, {0.4f, 0.4f}, {1.0f, 1.5f}}) {
        Scene scene;
        scene.delta_emitters = {spot_light(beam, cutoff)};
        double integral = 0;
        constexpr int kSteps = 200000;
        for (int i = 0; i < kSteps; ++i) {
            const double theta = cutoff * (i + 0.5) / kSteps;
            const double falloff = theta <= beam ? 1.0 : (cutoff - theta) / (cutoff - beam);
            integral += 2 * kPiD * falloff * std::sin(theta) * cutoff / kSteps;
        }
        EXPECT_NEAR(build_emitter_table(scene).total_power, integral, 1e-5 * integral);
    }
}

TEST(EmitterTable, EnvironmentPowerIsWhatEntersTheSceneSphere) {
    Scene scene = area_light_scene({0, 0, 0});
    const double radius = bounding_sphere(scene).radius;
    EXPECT_FLOAT_EQ(static_cast<float>(radius), std::sqrt(2.0f));
    scene.environment = patterned_map(1, 1);
    scene.environment.radiance = {{2, 2, 2}};
    // Every point of the sphere receives the irradiance π·2 from outside.
    EXPECT_NEAR(build_emitter_table(scene).total_power, 4 * kPiD * radius * radius * kPiD * 2, 1e-3);
    scene.environment = patterned_map(6, 5);
    const EmitterTable table = build_emitter_table(scene);
    Vec3 mean{0, 0, 0};
    for (int row = 0; row < 5; ++row) {  // solid angle of a pixel from the cosines of its edges
        const double share = (std::cos(kPiD * row / 5) - std::cos(kPiD * (row + 1) / 5)) / (2 * 6);
        for (int column = 0; column < 6; ++column) {
            mean += scene.environment.radiance[row * 6 + column] * static_cast<float>(share);
        }
    }
    EXPECT_NEAR(table.emitters[0].radiance.x, mean.x, 1e-6);
    EXPECT_NEAR(table.emitters[0].radiance.y, mean.y, 1e-6);
    EXPECT_NEAR(table.emitters[0].radiance.z, mean.z, 1e-6);
}

}  // namespace
}  // namespace nearlight::core
