// SPDX-License-Identifier: Apache-2.0
#include "host/session/picture_window.h"

#include <gtest/gtest.h>

#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class PictureWindowTest : public test::DeviceTest {};

/// A coated floor and a wall under a lamp, so that camera paths divide.
Scene coated_yard() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    const uint shiny = add_material(scene, coated(scene, {0.5f, 0.4f, 0.3f}, {.alpha = 0.2}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, shiny);
    add_quad(scene, {-2, -1, 1}, {0, 2, 0}, {4, 0, 0}, grey);
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 150;
    scene.camera.height = 83;
    return scene;
}

/// The settings under which bundles hold different things.
std::vector<RenderSettings> ways_to_bundle() {
    const GatherSettings few{.samples_per_pixel = 4, .direct_samples_per_pixel = 4, .rays_per_pixel = 4};
    RenderSettings plain{.sampling = {.vpl_count = 60}, .gather = few};
    std::vector<RenderSettings> ways(6, plain);
    ways[1].gather.strata = 1;
    ways[2].gather.interleave = 4;
    ways[3].sampling.cuts = true;
    ways[4].gather.roulette = 1.0f;
    ways[5].sampling.sampler = SamplerKind::local;
    return ways;
}

constexpr PixelWindow kWindows[] = {{0, 0, 150, 83},  {0, 0, 1, 1},     {149, 82, 1, 1},
                                    {37, 11, 50, 40}, {64, 64, 64, 19}, {3, 70, 147, 13}};

TEST_F(PictureWindowTest, APartHasTheBitsOfTheWholePicture) {
    const Scene scene = coated_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        for (RenderSettings settings : ways_to_bundle()) {
            settings.gather.window.reset();
            const Image whole = test::render_image(session, settings).image;
            for (const PixelWindow& window : kWindows) {
                settings.gather.window = window;
                const Image part = test::render_image(session, settings).image;
                ASSERT_EQ(part.width, static_cast<int>(window.width));
                ASSERT_EQ(part.height, static_cast<int>(window.height));
                std::size_t different = 0;
                for (int y = 0; y < part.height; ++y) {
                    for (int x = 0; x < part.width; ++x) {
                        for (std::size_t c = 0; c < part.channel_count(); ++c) {
                            const float same =
                                whole.at(x + static_cast<int>(window.x), y + static_cast<int>(window.y), c);
                            different += part.at(x, y, c) != same ? 1 : 0;
                        }
                    }
                }
                EXPECT_EQ(different, 0u)
                    << window.width << "x" << window.height << "+" << window.x << "+" << window.y
                    << ", sampler " << static_cast<int>(settings.sampling.sampler);
            }
        }
    });
}

TEST_F(PictureWindowTest, SeveralPassesOfAPartAreThoseOfTheWhole) {
    const Scene scene = coated_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings = ways_to_bundle()[0];
        settings.passes = 2;
        const Image whole = test::render_image(session, settings).image;
        settings.gather.window = PixelWindow{40, 20, 30, 30};
        const Image part = test::render_image(session, settings).image;
        for (std::size_t c = 0; c < NEARLIGHT_LAYER_VARIANCE; ++c) {
            EXPECT_EQ(part.at(7, 9, c), whole.at(47, 29, c)) << c;
        }
    });
}

TEST(PictureWindow, MustLieWithinThePicture) {
    EXPECT_EQ(window_of(30, 20, std::nullopt), (PixelWindow{0, 0, 30, 20}));
    EXPECT_EQ(window_of(30, 20, PixelWindow{29, 19, 1, 1}), (PixelWindow{29, 19, 1, 1}));
    for (const PixelWindow& window : {PixelWindow{0, 0, 31, 20},
                                      {0, 1, 30, 20},
                                      {30, 0, 1, 1},
                                      {0, 0, 0, 1},
                                      {4000000000u, 0, 4000000000u, 1}}) {
        EXPECT_THROW(window_of(30, 20, window), Error);
    }
}

}  // namespace
}  // namespace nearlight::core
