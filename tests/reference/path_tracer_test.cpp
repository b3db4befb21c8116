// SPDX-License-Identifier: Apache-2.0
#include "host/reference/path_tracer.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "host/base/random.h"
#include "nearlight/error.h"
#include "tests/reference/small_light_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

TEST(PathTracer, FurnaceSumsTheGeometricSeries) {
    constexpr float kAlbedo = 0.6f;
    const Scene scene = furnace(kAlbedo);
    double expected = 0;
    for (int depth = 1; depth <= 6; ++depth) {
        expected += std::pow(kAlbedo, depth - 1);
        const Image image =
            trace_paths(scene, {.width = 12, .height = 12, .spp = 64, .max_depth = depth, .threads = 2});
        EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 2e-4)
            << "max depth " << depth;
        EXPECT_NEAR(channel_mean(image, "direct.G") + channel_mean(image, "indirect.G"),
                    channel_mean(image, "G"), 1e-5);
    }
    const Image unlimited = trace_paths(scene, {.width = 12, .height = 12, .spp = 256, .threads = 2});
    EXPECT_NEAR(channel_mean(unlimited, "R"), 1 / (1 - kAlbedo), 4.5 * standard_error(unlimited) + 5e-4);
}

TEST(PathTracer, PointLightInASphereBouncesEvenly) {
    // Inside a sphere all pairs of points have the same geometry term, so each bounce brings ρ times the
    // irradiance of the bounce before it.
    constexpr float kAlbedo = 0.5f;
    constexpr float kRadius = 2.0f;
    Scene scene;
    add_inward_sphere(scene, kRadius, 3, add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    set_camera(scene, {0, 0.1, 0}, {0, 0, 1}, 50);
    const double irradiance = 1.0 / (kRadius * kRadius);
    const Image image = trace_paths(scene, {.width = 12, .height = 12, .spp = 64, .max_depth = 4});
    EXPECT_NEAR(channel_mean(image, "direct.R"), kAlbedo / kPi * irradiance,
                0.01 * irradiance * kAlbedo / kPi);
    const double indirect = kAlbedo / kPi * irradiance * (kAlbedo + kAlbedo * kAlbedo);
    EXPECT_NEAR(channel_mean(image, "indirect.R"), indirect, 4.5 * standard_error(image) + 0.01 * indirect);
}

/// Indirect radiance of the lower square at (0.3, 0, 0.2) after one bounce off the upper one, by quadrature.
double bounced_radiance(double albedo, double clamp_radius) {
    constexpr int kSteps = 600;
    double irradiance = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double x = -1 + 2 * (i + 0.5) / kSteps;
            const double z = -1 + 2 * (j + 0.5) / kSteps;
            const double light2 = (x - 0.2) * (x - 0.2) + 0.4 * 0.4 + (z - 0.1) * (z - 0.1);
            const double radiance = albedo / kPi * 0.4 / std::pow(light2, 1.5);
            const double r2 = (x - 0.3) * (x - 0.3) + 1 + (z - 0.2) * (z - 0.2);
            irradiance += radiance / r2 / std::max(r2, clamp_radius * clamp_radius);
        }
    }
    return albedo / kPi * irradiance * 4 / (double(kSteps) * kSteps);
}

TEST(PathTracer, ClampBoundsTheLastConnectionOnly) {
    const Scene scene = facing_squares(0.8f);
    double previous = std::numeric_limits<double>::infinity();
    for (const float radius : {0.0f, 1.2f, 2.0f}) {
        const Image image = trace_paths(scene, {.width = 4,
                                                .height = 4,
                                                .spp = 4096,
                                                .max_depth = 3,
                                                .clamp_radius = radius,
                                                .indirect_only = true});
        const double expected = bounced_radiance(0.8, radius);
        EXPECT_LT(expected, previous);
        previous = expected;
        EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 1e-3 * expected)
            << "R " << radius;
        EXPECT_EQ(channel_mean(image, "direct.R"), 0.0);
    }
}

TEST(PathTracer, AreaLightLightsAsLambertsFormulaSays) {
    // The irradiance of a surface parallel to a rectangle a × b, at height h below its corner.
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(2.0f);
    add_quad(scene, {0, 0.5f, 0}, {1, 0, 0}, {0, 0, 0.7f}, add_material(scene, lamp));
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    set_camera(scene, {-1, 0.4, -1}, {0, 0, 0}, 0.02);
    const double x = 1 / 0.5;
    const double y = 0.7 / 0.5;
    const double form = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                         y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                        (2 * kPi);
    const Image image = trace_paths(scene, {.width = 4, .height = 4, .spp = 1024, .max_depth = 2});
    EXPECT_NEAR(channel_mean(image, "R"), 0.5 * 2 * form, 4.5 * standard_error(image) + 1e-3 * form);
}

TEST(PathTracer, EnvironmentLightsAsItsPixelsSay) {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambertian({1, 1, 1})));
    set_camera(scene, {0.3, 1, 0.1}, {0, 0, 0}, 1);
    scene.environment.width = 8;
    scene.environment.height = 6;
    scene.environment.to_world = rotation(1, 2, 0.5, 50);
    Pcg32 random(5);
    for (int i = 0; i < 48; ++i) {
        const float value = i == 11 ? 30.0f : random.uniform();
        scene.environment.radiance.push_back({value, value, value});
    }
    double irradiance = 0;
    constexpr int kSteps = 960;
    for (int row = 0; row < kSteps; ++row) {
        for (int column = 0; column < kSteps; ++column) {
            const double theta = std::numbers::pi * (row + 0.5) / kSteps;
            const double phi = 2 * std::numbers::pi * (column + 0.5) / kSteps;
            const Vec3 local{static_cast<float>(std::sin(theta) * std::sin(phi)),
                             static_cast<float>(std::cos(theta)),
                             static_cast<float>(-std::sin(theta) * std::cos(phi))};
            const Vec3 direction = transform_vector(scene.environment.to_world, local);
            const int pixel = row * 6 / kSteps * 8 + column * 8 / kSteps;
            irradiance += scene.environment.radiance[static_cast<std::size_t>(pixel)].x *
                          std::max(0.0f, direction.y) * std::sin(theta) * (std::numbers::pi / kSteps) *
                          (2 * std::numbers::pi / kSteps);
        }
    }
    const Image image = trace_paths(scene, {.width = 8, .height = 8, .spp = 1024, .max_depth = 2});
    const double expected = irradiance / std::numbers::pi;
    EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 1e-3 * expected);
    EXPECT_LT(standard_error(image), 0.01 * expected);
}

TEST(PathTracer, PictureHasMitsubasHandednessAndHorizontalFov) {
    // The camera looks along +Z, so +X is on the left. At 90° the film is 2 wide at z = 1.
    Scene scene;
    Material red = lambertian({0, 0, 0});
    red.emission = parameter_of(Vec3{1, 0, 0});
    add_quad(scene, {0.5f, -1, 1}, {0, 2, 0}, {0.5f, 0, 0},
             add_material(scene, red));  // front faces the camera
    Material blue = red;
    blue.emission = parameter_of(Vec3{0, 0, 1});
    add_quad(scene, {-1, 0.25f, 1}, {0, 0.25f, 0}, {1, 0, 0}, add_material(scene, blue));
    scene.camera.fov_x_degrees = 90;
    const Image image = trace_paths(scene, {.width = 8, .height = 4, .spp = 4});
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(image.at(x, y, 0), x < 2 ? 1.0f : 0.0f) << x << ' ' << y;
            EXPECT_EQ(image.at(x, y, 2), x >= 4 && y == 0 ? 1.0f : 0.0f) << x << ' ' << y;
        }
    }
}

/// A wall that glows to the left of x = 0.1, an edge that is inside a pixel of a picture 4 pixels wide.
Scene glowing_edge() {
    Scene scene;
    Material glow = lambertian({0, 0, 0});
    glow.emission = parameter_of(1.0f);
    add_quad(scene, {0.1f, -2, 1}, {0, 4, 0}, {2, 0, 0}, add_material(scene, glow));
    scene.camera.fov_x_degrees = 90;
    return scene;
}

TEST(PathTracer, PixelCentersSeeOneSideOfAnEdge) {
    // At 90° the film is 2 wide and +X is on the left, so the edge crosses column 1 (x from 0.5 to 0) beside
    // its centre.
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 256};
    const Image blurred = trace_paths(glowing_edge(), settings);
    settings.pixel_centers = true;
    const Image sharp = trace_paths(glowing_edge(), settings);
    const auto variance = static_cast<std::size_t>(sharp.find_channel("variance.R"));
    for (int y = 0; y < 4; ++y) {
        EXPECT_NEAR(blurred.at(1, y, 0), 0.8, 0.05);
        for (int x = 0; x < 4; ++x) {
            EXPECT_EQ(sharp.at(x, y, 0), x < 2 ? 1.0f : 0.0f) << x << ' ' << y;
            EXPECT_EQ(sharp.at(x, y, variance), 0.0f);
        }
    }
}

TEST(PathTracer, PixelCentersAreInTheMiddle) {
    // The floor is 1 below the camera, and the ray through the middle of the picture meets it 2 ahead.
    Scene scene;
    add_quad(scene, {-9, -1, 0}, {0, 0, 9}, {18, 0, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    set_camera(scene, {0, 0, 0}, {0, -1, 2}, 40);
    const Image image = trace_paths(scene, {.width = 5, .height = 5, .spp = 32, .pixel_centers = true});
    EXPECT_NEAR(image.at(2, 2, static_cast<std::size_t>(image.find_channel("P.X"))), 0.0, 1e-4);
    EXPECT_NEAR(image.at(2, 2, static_cast<std::size_t>(image.find_channel("P.Z"))), 2.0, 1e-4);
}

TEST(PathTracer, PixelCentersLeaveTheMeanOfASmoothSceneAlone) {
    const Scene scene = furnace(0.6f);
    PathTracerSettings settings{.width = 12, .height = 12, .spp = 64, .max_depth = 4};
    const Image anywhere = trace_paths(scene, settings);
    settings.pixel_centers = true;
    const Image centers = trace_paths(scene, settings);
    EXPECT_NEAR(channel_mean(centers, "R"), 1 + 0.6 + 0.36 + 0.216, 4.5 * standard_error(centers) + 2e-4);
    EXPECT_NE(centers.values, anywhere.values);
}

/// A floor under a point light, seen from above.
Scene lit_floor() {
    Scene scene;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    add_point_light(scene, {0, 1, 0}, {1, 1, 1});
    set_camera(scene, {0, 3, 0}, {0, 0, 0}, 0.05, {0, 0, 1});
    return scene;
}

TEST(PathTracer, APaneDimsTheViewAndBlocksPointLights) {
    Scene scene = lit_floor();
    Material pane = thin_dielectric_material(1.5);
    pane.transmission = parameter_of(Vec3{1, 0.5f, 0.25f});
    const uint material = add_material(scene, pane);
    add_quad(scene, {-1, 2, -1}, {0, 0, 2}, {2, 0, 0}, material);  // before the camera
    const double face = 0.04;
    const double passed = 1 - 2 * face / (1 + face);
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 1024, .max_depth = 3};
    const Image image = trace_paths(scene, settings);
    EXPECT_NEAR(channel_mean(image, "R"), 0.5 / kPi * passed, 4.5 * standard_error(image));
    EXPECT_NEAR(channel_mean(image, "B") / channel_mean(image, "R"), 1 / 4.0, 1e-4);
    EXPECT_NEAR(channel_mean(image, "direct.R"), channel_mean(image, "R"), 1e-6);
    EXPECT_NEAR(channel_mean(image, "depth.Z"), 1, 1e-4);
    EXPECT_NEAR(channel_mean(image, "P.Y"), 0, 1e-3);
    settings.max_depth = 2;
    EXPECT_EQ(channel_mean(trace_paths(scene, settings), "R"), 0) << "panes count for the depth";
    settings.max_depth = 4;
    add_quad(scene, {-1, 0.5f, -1}, {0, 0, 2}, {2, 0, 0}, material);  // between light and floor
    EXPECT_EQ(channel_mean(trace_paths(scene, settings), "R"), 0);
}

TEST(PathTracer, PanesOnTheWayToALightCountForTheDepth) {
    Scene scene = facing_squares(0.8f);
    scene.clear_glass = true;
    add_quad(scene, {-0.1f, 0.5f, -0.2f}, {0, 0, 0.6f}, {0.6f, 0, 0},
             add_material(scene, thin_dielectric_material(1.5)));  // below the light, not before the camera
    set_camera(scene, {0.0, 0.4, 0.0}, {0.3, 0.0, 0.2}, 0.05);
    PathTracerSettings settings{.width = 4, .height = 4, .spp = 16, .max_depth = 2};
    EXPECT_EQ(channel_mean(trace_paths(scene, settings), "direct.R"), 0);
    settings.max_depth = 3;
    const double to_light2 = 0.1 * 0.1 + 0.6 * 0.6 + 0.1 * 0.1;
    const double unhidden = 0.8 / kPi * 0.6 / std::pow(to_light2, 1.5);
    const double found = channel_mean(trace_paths(scene, settings), "direct.R");
    EXPECT_LT(found, 0.95 * unhidden);
    EXPECT_GT(found, 0.85 * unhidden);
}

TEST(PathTracer, EachPixelHasRandomNumbersOfItsOwn) {
    Scene scene;
    add_quad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, add_material(scene, lambertian({1, 1, 1})));
    scene.environment = patterned_map(16, 8);
    set_camera(scene, {0, 1, 0}, {0.001, 0, 0}, 40);
    scene.camera.kind = CameraKind::orthographic;  // so that all pixels see the same but for chance
    const Image image = trace_paths(scene, {.width = 6, .height = 6, .spp = 1, .max_depth = 2});
    const auto blue = static_cast<std::size_t>(image.find_channel("B"));
    std::set<float> values;
    for (int i = 0; i < 36; ++i) {
        values.insert(image.at(i % 6, i / 6, blue));
    }
    EXPECT_EQ(values.size(), 36u);
}

TEST(PathTracer, TheAlbedoBelowACoatIsTheMeanOverSamplesOfEitherPart) {
    Scene scene;
    const Material coat = coated(scene, {0.5f, 0.5f, 0.5f}, {.eta = 1.5});
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, coat));
    set_camera(scene, {0, 1, 0}, {0.001, 0, 0}, 0.05);
    const Image image = trace_paths(scene, {.width = 4, .height = 4, .spp = 1024, .max_depth = 2});
    const double albedo = 0.5 / (1 - coat.internal_reflectance) / (1.5 * 1.5) * (1 - 0.04);
    EXPECT_NEAR(channel_mean(image, "albedo.R"), albedo, 0.02 * albedo);
}

TEST(PathTracer, AMirrorShowsTheReceiver) {
    Scene scene = lit_floor();
    // An index of i reflects everything.
    const Material mirror = conductor_material({0, 0, 0}, {1, 1, 1}, {0.9f, 0.9f, 0.9f});
    add_quad(scene, {1, 2, -1}, {1, -1, 0}, {0, 0, 2}, add_material(scene, mirror));
    set_camera(scene, {0, 1.5, 0}, {1.5, 1.5, 0}, 0.05);
    // The mirror at 45° sends the view down to (1.5, 0, 0) on the floor.
    const double distance2 = 1.5 * 1.5 + 1;
    const Image image = trace_paths(scene, {.width = 4, .height = 4, .spp = 16, .max_depth = 3});
    EXPECT_NEAR(channel_mean(image, "N.Y"), 1, 1e-5);
    EXPECT_NEAR(channel_mean(image, "P.X"), 1.5, 0.01);
    EXPECT_NEAR(channel_mean(image, "R"), 0.9 * 0.5 / kPi * std::pow(distance2, -1.5), 2e-4);
    EXPECT_NEAR(channel_mean(image, "albedo.R"), 0.45, 1e-5);
}

TEST(PathTracer, TheBackOfAOneSidedSurfaceIsBlack) {
    Scene scene = lit_floor();
    set_camera(scene, {0, -3, 0}, {0, 0, 0}, 10, {0, 0, 1});
    add_point_light(scene, {0, -1, 0}, {1, 1, 1});
    EXPECT_EQ(channel_mean(trace_paths(scene, {.width = 4, .height = 4, .spp = 4}), "R"), 0.0);
    const uint both = add_material(scene, two_sided_material(0, 0));
    for (Triangle& triangle : scene.triangles) {
        triangle.material = both;
    }
    EXPECT_GT(channel_mean(trace_paths(scene, {.width = 4, .height = 4, .spp = 4}), "R"), 0.1);
}

TEST(PathTracer, SenselessSettingsAreRefused) {
    EXPECT_THROW(trace_paths(lit_floor(), {.spp = 0}), Error);
    EXPECT_THROW(trace_paths(lit_floor(), {.max_depth = -2}), Error);
    EXPECT_THROW(trace_paths(lit_floor(), {.clamp_radius = -1}), Error);
}

}  // namespace
}  // namespace nearlight::core
