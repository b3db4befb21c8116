// SPDX-License-Identifier: Apache-2.0
// The samples of a pixel share sequences of random numbers (lib/camera_sample.cl).
#include <gtest/gtest.h>

#include <array>

#include "host/scene/material_model.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::GBuffer;
using test::Shooting;

class CameraSamplesTest : public test::DeviceTest {};

/// What the samples of a pixel see in rough metal is evenly spread over the directions of its gloss.
TEST_F(CameraSamplesTest, AreEvenlySpreadOverGloss) {
    Scene scene;
    Material metal = conductor_material({0.2f, 0.9f, 1.1f}, {3.9f, 2.5f, 2.1f});
    metal.roughness = parameter_of(0.4f);
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, add_material(scene, metal));
    scene.environment = {.width = 2, .height = 1, .radiance = {{0, 0, 0}, {1, 1, 1}}, .to_world = {}};
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 0.001);
    constexpr uint kSamples = 64;
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 8, 8);
        // All pixels see the same, so that the spread of their light is noise.
        const auto variance = [&](uint samples) {
            const GBuffer found = shooting.shoot_all(samples, 1);
            std::array<double, NEARLIGHT_PACKET_SIZE> pixels{};
            for (std::size_t i = 0; i < found.vertices.size(); ++i) {
                pixels.at(i % pixels.size()) += double{found.vertices[i].camera_light.y} / samples;
            }
            double sum = 0, squares = 0;
            for (const double pixel : pixels) {
                sum += pixel;
                squares += pixel * pixel;
            }
            const double count = pixels.size();
            EXPECT_GT(sum, 0.1 * count);
            return squares / count - sum / count * (sum / count);
        };
        EXPECT_LT(variance(kSamples), 0.4 * variance(1) / kSamples);
    });
}

}  // namespace
}  // namespace nearlight::core
