// SPDX-License-Identifier: Apache-2.0
// What cameras, films and depth limits do to whole pictures, by the renderer and by the reference path
// tracer.
#include <cmath>
#include <numbers>

#include "host/reference/path_tracer.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

Material glowing(float radiance) {
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(radiance);
    return lamp;
}

/// A square across the view of a camera at the origin that looks along +Z, with its front to the camera.
void add_screen(Scene& scene, float side, float z, uint material, float x = 0.0f) {
    add_quad(scene, {x - side / 2, -side / 2, z}, {0, side, 0}, {side, 0, 0}, material);
}
void add_screen(Scene& scene, float side, float z, const Material& material, float x = 0.0f) {
    add_screen(scene, side, z, add_material(scene, material), x);
}

float value(const Image& image, const char* channel, int x, int y) {
    return image.at(x, y, static_cast<std::size_t>(image.find_channel(channel)));
}

class SensorsTest : public test::DeviceTest {
  protected:
    /// Checks the pictures of the renderer, on each device, and of the path tracer.
    template <typename Check>
    void on_each_picture(const Scene& scene, int samples, Check&& check) {
        {
            SCOPED_TRACE("path tracer");
            check(trace_paths(scene, {.spp = samples, .max_depth = scene.max_depth}));
        }
        on_each_device([&](Device& device) {
            const RenderSettings settings{
                .sampling = {.vpl_count = 64},
                .gather = {.samples_per_pixel = static_cast<uint>(samples), .direct_samples_per_pixel = 16}};
            check(test::render_image(device, scene, settings).image);
        });
    }
};

TEST_F(SensorsTest, LensBlursAPointToTheCircleOfConfusion) {
    // A small square of radiance 1 and side s at the distance D. On the plane at distance 1, the lens spreads
    // its (s/D)² evenly over the disc of radius A·|1/D − 1/F|.
    constexpr double kSide = 0.08, kRadius = 0.3, kFocus = 2.0;
    for (const double distance : {1.2, 3.5}) {
        Scene scene;
        add_screen(scene, static_cast<float>(kSide), static_cast<float>(distance), glowing(1000.0f));
        scene.camera.fov_x_degrees = 40;
        scene.camera.width = scene.camera.height = 32;
        scene.camera.aperture_radius = kRadius;
        scene.camera.focus_distance = kFocus;
        scene.max_depth = 1;
        const double disc = kRadius * std::abs(1.0 / distance - 1.0 / kFocus);
        const double pixel = 2.0 * std::tan(20.0 * std::numbers::pi / 180.0) / 32;
        const double spot = kSide / distance;
        on_each_picture(scene, 4096, [&](const Image& image) {
            double flux = 0.0, second_moment = 0.0;
            for (int y = 0; y < 32; ++y) {
                for (int x = 0; x < 32; ++x) {
                    const double light = value(image, "R", x, y) * pixel * pixel;
                    const double r = std::hypot(x - 15.5, y - 15.5) * pixel;
                    flux += light;
                    second_moment += light * r * r;
                    EXPECT_TRUE(light == 0.0 || r < disc + spot + pixel) << x << " " << y;
                }
            }
            const double expected_flux = 1000.0 * spot * spot;
            EXPECT_NEAR(flux, expected_flux, 0.05 * expected_flux);
            // A disc's is R²/2; the spot and the pixel add their own, s²/6 each.
            const double expected_moment = disc * disc / 2 + (spot * spot + pixel * pixel) / 6;
            EXPECT_NEAR(second_moment / flux, expected_moment, 0.05 * expected_moment);
        });
    }
}

TEST_F(SensorsTest, InFocusALensIsSharp) {
    Scene scene;
    add_screen(scene, 0.5f, 2.0f, glowing(1.0f));
    scene.camera.fov_x_degrees = 2 * 45;  // 4 wide at the distance 2
    scene.camera.width = scene.camera.height = 16;
    scene.camera.aperture_radius = 0.4;
    scene.camera.focus_distance = 2.0;
    scene.max_depth = 1;
    on_each_picture(scene, 16, [](const Image& image) {
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const bool inside = x >= 7 && x < 9 && y >= 7 && y < 9;
                EXPECT_NEAR(value(image, "R", x, y), inside ? 1.0f : 0.0f, 1e-4f) << x << " " << y;
            }
        }
    });
}

TEST_F(SensorsTest, OrthographicSizeDoesNotDependOnTheDistance) {
    Scene scene;
    add_screen(scene, 1.0f, 1.0f, glowing(1.0f), -1.5f);
    add_screen(scene, 1.0f, 30.0f, glowing(1.0f), 1.5f);
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.to_world = scaling(4, 4, 1);  // 8 wide
    scene.camera.width = 32;
    scene.camera.height = 16;
    scene.max_depth = 1;
    on_each_picture(scene, 1, [](const Image& image) {
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 32; ++x) {
                const bool in_row = y >= 6 && y < 10;
                const bool far = x >= 8 && x < 12;  // +X is to the left
                const bool near = x >= 20 && x < 24;
                EXPECT_EQ(value(image, "R", x, y), in_row && (far || near) ? 1.0f : 0.0f) << x << " " << y;
                EXPECT_NEAR(value(image, "depth.Z", x, y), in_row && far ? 30 : in_row && near ? 1 : 0, 1e-4);
            }
        }
    });
}

TEST_F(SensorsTest, CropIsAPartOfTheWholePicture) {
    Scene scene = court_under_sky();
    scene.camera.width = 40;
    scene.camera.height = 24;
    Scene part = scene;
    part.camera.width = 16;
    part.camera.height = 12;
    part.camera.film_part = 16.0 / 40.0;
    part.camera.center_x = (9 + 8 - 20) / 40.0;
    part.camera.center_y = (5 + 6 - 12) / 40.0;
    const auto compare = [](const Image& all, const Image& crop) {
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 16; ++x) {
                for (const char* channel : {"P.X", "P.Y", "P.Z", "N.X", "albedo.R", "depth.Z"}) {
                    EXPECT_NEAR(value(crop, channel, x, y), value(all, channel, x + 9, y + 5), 1e-4f)
                        << channel << " " << x << " " << y;
                }
            }
        }
    };
    const PathTracerSettings centers{.spp = 1, .pixel_centers = true};
    compare(trace_paths(scene, centers), trace_paths(part, centers));
    on_each_device([&](Device& device) {
        const RenderSettings settings{.sampling = {.vpl_count = 10}, .gather = {.samples_per_pixel = 1}};
        compare(test::render_image(device, scene, settings).image,
                test::render_image(device, part, settings).image);
    });
}

TEST_F(SensorsTest, ClipPlanesHideSurfacesFromTheCameraAlone) {
    // A lamp shines from the side on a far wall, and a clipped plate casts its shadow on the left half.
    Scene scene;
    const Material white = lambertian({0.5f, 0.5f, 0.5f});
    add_screen(scene, 8.0f, 4.0f, white);
    add_screen(scene, 4.0f, 1.0f, add_two_sided(scene, white), 2.0f);
    add_point_light(scene, {0, 0, 0.5f}, {10, 10, 10});
    scene.environment = {.width = 1, .height = 1, .radiance = {{3, 3, 3}}, .to_world = {}};
    scene.camera.width = scene.camera.height = 8;
    scene.camera.fov_x_degrees = 60;
    scene.max_depth = 2;
    const Scene unclipped = scene;
    scene.camera.near_clip = 2.0;
    on_each_picture(scene, 4, [](const Image& image) {
        EXPECT_NEAR(value(image, "P.Z", 1, 4), 4.0f, 1e-3f);
        EXPECT_NEAR(value(image, "P.Z", 6, 4), 4.0f, 1e-3f);
    });
    scene.environment = {};
    on_each_picture(scene, 4, [](const Image& image) {
        EXPECT_EQ(value(image, "R", 1, 4), 0.0f);  // in the plate's shadow
        EXPECT_GT(value(image, "R", 6, 4), 0.01f);
    });
    scene = unclipped;
    scene.camera.near_clip = 0.1;
    scene.camera.far_clip = 2.0;
    on_each_picture(scene, 4, [](const Image& image) {
        EXPECT_NEAR(value(image, "P.Z", 1, 4), 1.0f, 1e-3f);
        EXPECT_EQ(value(image, "R", 6, 4), 3.0f);  // nothing but the sky
        EXPECT_EQ(value(image, "depth.Z", 6, 4), 0.0f);
    });
}

TEST_F(SensorsTest, HiddenEmittersAreSeenInMirrorsOnly) {
    // A lamp before the left half of the view, behind the camera a second one, and a mirror on the right.
    Scene scene;
    add_screen(scene, 4.0f, 1.0f, glowing(5.0f), 2.0f);
    add_quad(scene, {-10, -10, -3}, {20, 0, 0}, {0, 20, 0}, add_material(scene, glowing(7.0f)));
    add_screen(scene, 4.0f, 2.0f, conductor_material({0, 0, 0}, {1e4f, 1e4f, 1e4f}), -2.0f);
    scene.environment = {.width = 1, .height = 1, .radiance = {{3, 3, 3}}, .to_world = {}};
    scene.camera.width = scene.camera.height = 8;
    scene.camera.fov_x_degrees = 60;
    scene.max_depth = 2;  // the mirror counts
    on_each_picture(scene, 4, [](const Image& image) {
        EXPECT_NEAR(value(image, "R", 1, 4), 5.0f, 1e-3f);
        EXPECT_NEAR(value(image, "R", 6, 4), 7.0f, 0.01f);
    });
    scene.camera.hide_emitters = true;
    on_each_picture(scene, 4, [](const Image& image) {
        EXPECT_EQ(value(image, "R", 1, 4), 0.0f);  // neither the lamp nor the sky behind it
        EXPECT_EQ(value(image, "depth.Z", 1, 4), 0.0f);
        EXPECT_NEAR(value(image, "R", 6, 4), 7.0f, 0.01f);
    });
}

TEST_F(SensorsTest, MonochromePictureIsTheLuminanceOfTheOther) {
    Scene scene = court_under_sky();
    scene.camera.width = scene.camera.height = 16;
    scene.max_depth = 2;
    Scene gray = scene;
    gray.camera.is_monochrome = true;
    const auto compare = [](const Image& color, const Image& luminances) {
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const float expected =
                    luminance({value(color, "R", x, y), value(color, "G", x, y), value(color, "B", x, y)});
                for (const char* channel : {"R", "G", "B"}) {
                    EXPECT_NEAR(value(luminances, channel, x, y), expected, 1e-5f + 1e-5f * expected);
                }
                EXPECT_EQ(value(luminances, "albedo.R", x, y), value(color, "albedo.R", x, y));
            }
        }
    };
    // The noise of the luminance is that of channels whose noises rise and fall together.
    const auto compare_noise = [](const Image& color, const Image& luminances) {
        const auto noise = [&](const char* channel, int x, int y) {
            return std::sqrt(value(color, channel, x, y));
        };
        float sum = 0;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const float expected = luminance(
                    {noise("variance.R", x, y), noise("variance.G", x, y), noise("variance.B", x, y)});
                for (const char* channel : {"variance.R", "variance.G", "variance.B"}) {
                    EXPECT_NEAR(std::sqrt(value(luminances, channel, x, y)), expected, 1e-4f * expected);
                }
                sum += expected;
            }
        }
        EXPECT_GT(sum, 0.0f);
    };
    compare(trace_paths(scene, {.spp = 4, .max_depth = 2}), trace_paths(gray, {.spp = 4, .max_depth = 2}));
    on_each_device([&](Device& device) {
        const Image color = test::render_image(device, scene, test::few_vpls()).image;
        const Image luminances = test::render_image(device, gray, test::few_vpls()).image;
        compare(color, luminances);
        compare_noise(color, luminances);
    });
}

TEST_F(SensorsTest, DepthOneIsEmissionAlone) {
    Scene scene = court_under_sky();
    scene.camera.width = scene.camera.height = 16;
    scene.max_depth = 1;
    on_each_picture(scene, 1, [&](const Image& image) {
        int surfaces = 0;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const bool is_surface = value(image, "depth.Z", x, y) > 0.0f;
                surfaces += is_surface ? 1 : 0;
                EXPECT_EQ(value(image, "indirect.R", x, y), 0.0f);
                if (is_surface) {
                    EXPECT_EQ(value(image, "R", x, y), 0.0f) << x << " " << y;
                } else {
                    EXPECT_GT(value(image, "R", x, y), 0.1f) << x << " " << y;
                }
            }
        }
        EXPECT_GT(surfaces, 50);
        EXPECT_LT(surfaces, 250);
    });
}

/// With every filter, the renderer's picture is that of the path tracer.
TEST_F(SensorsTest, FiltersOfTheRendererAndOfThePathTracerAgree) {
    Scene scene = court_under_sky();
    add_screen(scene, 0.2f, 0.3f, glowing(20.0f));
    scene.camera.width = scene.camera.height = 12;
    scene.max_depth = 1;
    for (const FilterKind kind : {FilterKind::tent, FilterKind::gaussian, FilterKind::mitchell,
                                  FilterKind::catmull_rom, FilterKind::lanczos}) {
        SCOPED_TRACE(to_string(kind));
        scene.camera.filter = default_filter(kind);
        const Image expected = trace_paths(scene, {.spp = 4096, .max_depth = 1});
        on_each_device([&](Device& device) {
            const RenderSettings settings{.sampling = {.vpl_count = 0},
                                          .gather = {.samples_per_pixel = 4096}};
            const Image found = test::render_image(device, scene, settings).image;
            for (int y = 0; y < 12; ++y) {
                for (int x = 0; x < 12; ++x) {
                    const auto variance = static_cast<double>(value(expected, "variance.R", x, y));
                    EXPECT_NEAR(value(found, "R", x, y), value(expected, "R", x, y),
                                0.05 + 6.0 * std::sqrt(variance))
                        << x << " " << y;
                }
            }
        });
    }
}

}  // namespace
}  // namespace nearlight::core
