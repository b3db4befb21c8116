// SPDX-License-Identifier: Apache-2.0
// The path tracer with surfaces that reflect other than diffusely: furnaces with known answers, light that
// reaches matter in several ways, layers, and the clamped expectation.
#include <gtest/gtest.h>

#include "host/reference/path_tracer.h"
#include "tests/reference/bsdf_cases.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// The square of a case in a white environment, seen from a direction of the given cosine through a narrow
/// lens.
Scene square_in_furnace(const BsdfCase& test, double cosine, float sky = 1.0f) {
    Scene scene = test.scene;
    scene.environment = {.width = 1, .height = 1, .radiance = {{sky, sky, sky}}, .to_world = {}};
    const Vec3d eye = Vec3d{0.5, 0.25, 0} + towards(cosine) * 2;
    set_camera(scene, {eye.x, eye.y, eye.z}, {0.5, 0.25, 0}, 0.1, {0, 0.1, 1});
    return scene;
}

TEST(GlossyPaths, SquaresSendTheirAlbedoInAWhiteFurnace) {
    for (const BsdfCase& test : all_bsdf_cases()) {
        for (const double cosine : {0.8, -0.5}) {
            const Scene scene = square_in_furnace(test, cosine);
            const SurfaceBsdf bsdf = test.seen_from(towards(cosine));
            Vec3d expected;
            constexpr int kSamples = 100'000;
            for (int i = 0; i < kSamples; ++i) {
                const BsdfRandom random = even_random(i);
                expected += bsdf.has_diffuse() ? bsdf.sample_diffuse(random).weight / kSamples : Vec3d{};
                expected += bsdf.sample_specular(random).weight / kSamples;
            }
            const Image image = trace_paths(scene, {.width = 4, .height = 4, .spp = 512, .max_depth = 3});
            EXPECT_NEAR(channel_mean(image, "R"), expected.x, 4.5 * standard_error(image) + 2e-3)
                << test.name << " at " << cosine;
        }
    }
}

/// A closed sphere of a material whose emission is 1 and which is seen from within.
Scene glossy_furnace(const std::function<Material(Scene&)>& make) {
    Scene scene;
    Material wall = make(scene);
    wall.emission = parameter_of(1.0f);
    add_inward_sphere(scene, 2.0f, 2, add_material(scene, wall));
    set_camera(scene, {0.3, 0.2, 0}, {0, 0, 1}, 60);
    return scene;
}

TEST(GlossyPaths, AMirrorSphereSumsItsReflections) {
    // Every reflection brings the radiance 1 again, times 0.8.
    const Scene scene = glossy_furnace([](Scene&) {
        return conductor_material({0, 0, 0}, {1, 1, 1}, {0.8f, 0.8f, 0.8f});
    });
    double expected = 0;
    for (int depth = 1; depth <= 4; ++depth) {
        expected += std::pow(0.8, depth - 1);
        const Image image = trace_paths(scene, {.width = 6, .height = 6, .spp = 8, .max_depth = depth});
        EXPECT_NEAR(channel_mean(image, "R"), expected, 1e-4) << depth;
        EXPECT_NEAR(channel_mean(image, "direct.R"), expected, 1e-4) << depth;
    }
    const Image unlimited = trace_paths(scene, {.width = 8, .height = 8, .spp = 256, .max_depth = -1});
    EXPECT_NEAR(channel_mean(unlimited, "R"), 5, 4.5 * standard_error(unlimited) + 1e-3);
}

TEST(GlossyPaths, AGlassBallVanishesInAFurnace) {
    // A clear body among equal radiance sends just that, whatever it refracts and reflects.
    Scene scene;
    add_inward_sphere(scene, 1.0f, 2, add_material(scene, dielectric_material(1.5)));
    for (Triangle& triangle : scene.triangles) {
        std::swap(triangle.v1, triangle.v2);
    }
    scene.environment = {.width = 1, .height = 1, .radiance = {{1, 1, 1}}, .to_world = {}};
    set_camera(scene, {0, 0, -3}, {0, 0, 0}, 20);
    const Image image = trace_paths(scene, {.width = 12, .height = 12, .spp = 256});
    EXPECT_NEAR(channel_mean(image, "R"), 1, 4.5 * standard_error(image) + 1e-3);
    EXPECT_EQ(channel_mean(image, "indirect.R"), 0);
}

/// A rough plate under a small lamp, seen by way of its highlight.
Scene highlight(float alpha, bool point) {
    Scene scene;
    add_quad(scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, add_material(scene, rough(gold(), alpha, alpha)));
    if (point) {
        add_point_light(scene, {0.5f, 1, 0}, {1, 1, 1});
    } else {
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(100.0f);  // 0.1 × 0.1, facing down: intensity 1 straight below
        add_quad(scene, {0.45f, 1, -0.05f}, {0.1f, 0, 0}, {0, 0, 0.1f}, add_material(scene, lamp));
    }
    set_camera(scene, {-0.8, 1.2, 0.1}, {-0.1, 0, 0}, 0.05);
    return scene;
}

TEST(GlossyPaths, APointLightHasAHighlight) {
    const Image image =
        trace_paths(highlight(0.3f, true), {.width = 2, .height = 2, .spp = 4, .max_depth = 2});
    const Vec3d view = normalize(Vec3d{-0.7, 1.2, 0.1});
    const Vec3d light{0.6, 1, 0};
    const auto z_up = [](Vec3d v) { return Vec3d{v.x, v.z, v.y}; };
    const BsdfCase plate = bsdf_case("", [](Scene&) { return rough(gold(), 0.3f, 0.3f); });
    const Vec3d value = plate.seen_from(z_up(view)).eval(z_up(normalize(light))).specular;
    EXPECT_NEAR(channel_mean(image, "R"), value.x / dot(light, light), 2e-3 * value.x);
    EXPECT_NEAR(channel_mean(image, "direct.G"), value.y / dot(light, light), 2e-3 * value.y);
}

TEST(GlossyPaths, LampsInGlossAgreeWithQuadrature) {
    // Light sampling prevails on the rough plate, BSDF sampling on the smooth one.
    for (const float alpha : {0.5f, 0.05f}) {
        const BsdfCase plate = bsdf_case("", [&](Scene&) { return rough(gold(), alpha, alpha); });
        const Vec3d view = normalize(Vec3d{-0.7, 1.2, 0.1});
        const auto z_up = [](Vec3d v) { return Vec3d{v.x, v.z, v.y}; };
        double expected = 0;
        constexpr int kSteps = 200;
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const Vec3d to_lamp{0.55 + 0.1 * (i % kSteps + 0.5) / kSteps, 1,
                                -0.05 + 0.1 * (static_cast<double>(i) / kSteps) / kSteps};
            const Vec3d direction = normalize(to_lamp);
            expected += plate.seen_from(z_up(view)).eval(z_up(direction)).specular.x * 100 * direction.y /
                        dot(to_lamp, to_lamp) * 0.01 / (kSteps * kSteps);
        }
        const Image image =
            trace_paths(highlight(alpha, false), {.width = 4, .height = 4, .spp = 2048, .max_depth = 2});
        EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 5e-3 * expected)
            << alpha;
        EXPECT_LT(standard_error(image), 0.02 * expected) << alpha;
    }
}

TEST(GlossyPaths, LampsBehindAMaskAreFoundThroughItsHoles) {
    // A mask of opacity 0.4 hides the lamp, and is black where it is solid.
    for (const bool masked : {false, true}) {
        Scene scene;
        add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0},
                 add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(2.0f);
        add_quad(scene, {-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, lamp));
        set_camera(scene, {-1.5, 0.4, 0}, {0, 0, 0}, 0.02);
        const double x = 0.5;
        const double form = 4 * (x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x))) / kPi;
        if (masked) {
            const uint black = add_material(scene, lambertian({0, 0, 0}));
            const uint mask = add_material(scene, mask_material(parameter_of(0.4f), black));
            add_quad(scene, {-1, 0.5f, -1}, {2, 0, 0}, {0, 0, 2}, mask);
        }
        const Image image = trace_paths(scene, {.width = 4, .height = 4, .spp = 2048, .max_depth = 3});
        const double expected = 0.5 * 2 * form * (masked ? 0.6 : 1);
        EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 1e-3);
        // Light that comes straight through holes is direct light.
        EXPECT_NEAR(channel_mean(image, "direct.R"), channel_mean(image, "R"), 1e-6);
    }
}

/// Paths of a clamped picture end at veils behind their receiver, but no light may end with them.
TEST(GlossyPaths, AClampLeavesLightBehindVeilsAsItIs) {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, grey);
    add_quad(scene, {1, 0, -2}, {0, 0, 4}, {0, 2, 0}, grey);  // a wall that faces −x
    const uint hole = add_material(scene, mask_material(parameter_of(0.2f), grey));
    add_quad(scene, {-3, 2.5f, -3}, {6, 0, 0}, {0, 0, 6}, hole);
    scene.environment = {.width = 2, .height = 1, .radiance = {{1, 1, 1}, {1, 1, 1}}, .to_world = {}};
    set_camera(scene, {-1.5, 0.8, 0}, {0.5, 0, 0}, 0.05);
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 4096, .max_depth = 4};
    const Image whole = trace_paths(scene, settings);
    settings.clamp_radius = 0.001f;
    const Image clamped = trace_paths(scene, settings);
    for (const std::string layer : {"direct", "indirect"}) {
        EXPECT_GT(channel_mean(whole, layer + ".R"), 0.01) << layer;
        EXPECT_NEAR(channel_mean(clamped, layer + ".R"), channel_mean(whole, layer + ".R"),
                    4.5 * std::hypot(standard_error(whole), standard_error(clamped)))
            << layer;
    }
}

/// A matt floor beside a wall of the material under a lamp; the view is of the floor.
Scene floor_and_wall(const std::function<Material(Scene&)>& wall) {
    Scene scene;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    const uint material = add_material(scene, wall(scene));
    add_quad(scene, {1, 0, -2}, {0, 0, 4}, {0, 3, 0}, material);  // faces −x
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(10.0f);
    add_quad(scene, {-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_material(scene, lamp));
    set_camera(scene, {-1.5, 0.8, 0}, {0.5, 0, 0}, 0.05);
    return scene;
}

TEST(GlossyPaths, AClampLeavesOutWhatOtherSurfacesMirror) {
    const auto mirror = [](Scene&) { return conductor_material({0, 0, 0}, {1, 1, 1}, {0.9f, 0.9f, 0.9f}); };
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 4096, .max_depth = 3, .indirect_only = true};
    const Image true_light = trace_paths(floor_and_wall(mirror), settings);
    EXPECT_GT(channel_mean(true_light, "R"), 0.01);
    settings.clamp_radius = 0.001f;
    EXPECT_EQ(channel_mean(trace_paths(floor_and_wall(mirror), settings), "R"), 0);
    // Of a coated wall the base remains, and a radius this small takes nothing from it.
    const auto coated = [](Scene& scene) {
        return colored(plastic_material(scene, {.eta = 1.5, .alpha = 0.2}), {0.6f, 0.6f, 0.6f});
    };
    const Image base = trace_paths(floor_and_wall(coated), settings);
    settings.clamp_radius = 0;
    const Image all = trace_paths(floor_and_wall(coated), settings);
    EXPECT_GT(channel_mean(all, "R") - channel_mean(base, "R"),
              4.5 * (standard_error(all) + standard_error(base)));
    EXPECT_GT(channel_mean(base, "R"), 0.5 * channel_mean(all, "R"));
}

TEST(GlossyPaths, ALargeClampRadiusTakesLightInProportion) {
    // Every point of the wall is nearer than 100 m, so the indirect light shrinks with 1/R².
    const auto white = [](Scene&) { return lambertian({0.8f, 0.8f, 0.8f}); };
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 2048, .max_depth = 3, .indirect_only = true};
    settings.clamp_radius = 100;
    const double far = channel_mean(trace_paths(floor_and_wall(white), settings), "R");
    settings.clamp_radius = 200;
    EXPECT_NEAR(far / channel_mean(trace_paths(floor_and_wall(white), settings), "R"), 4, 1e-3);
}

}  // namespace
}  // namespace nearlight::core
