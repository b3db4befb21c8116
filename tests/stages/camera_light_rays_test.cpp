// SPDX-License-Identifier: Apache-2.0
// Rays that rough surfaces send in search of lights (CameraBatch::light_rays): they change the noise of a
// picture, and not its expectation.
#include "host/base/random.h"
#include "host/stages/camera_pass.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::Shooting;

class CameraLightRaysTest : public test::DeviceTest {};

/// A rough floor in front of a lamp, one half of which stands behind a pane, under a sky that is bright at a
/// side. The camera sees the floor straight.
Scene lamp_and_sky_over_rough_floor(bool is_coated) {
    Scene scene;
    Material floor = conductor_material({0, 0, 0}, {1, 1, 1}, {0.8f, 0.7f, 0.6f});
    if (is_coated) {
        floor = coated(scene, {0.5f, 0.4f, 0.3f}, {.alpha = 0.2});
    } else {
        floor.roughness = parameter_of(0.2f);
    }
    add_quad(scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, add_material(scene, floor));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{9, 9, 9});
    add_quad(scene, {-1, 0.2f, 2}, {0, 1, 0}, {2, 0, 0}, add_material(scene, lamp));  // faces −Z
    add_quad(scene, {-1, 0, 1.8f}, {0, 2, 0}, {1, 0, 0}, add_material(scene, thin_dielectric_material(1.5)));
    scene.environment = {.width = 4,
                         .height = 2,
                         .radiance = {{0.5f, 0.5f, 0.5f},
                                      {4, 4, 4},
                                      {0.5f, 0.5f, 0.5f},
                                      {0.5f, 0.5f, 0.5f},
                                      {0, 0, 0},
                                      {0, 0, 0},
                                      {0, 0, 0},
                                      {0, 0, 0}},
                         .to_world = {}};
    set_camera(scene, {0, 1, -1.5f}, {0, 0, 0.4f}, 20);
    return scene;
}

struct Estimate {
    double mean = 0;
    double variance = 0;  // of one sample of a pixel, mean over pixels
};

/// The light that 8×8 pixels see of lamps, by `rays` rays at the floor.
Estimate seen_light(Shooting& shooting, uint rays, uint samples) {
    const test::GBuffer found = shooting.shoot({.tile_row_count = 1,
                                                .sample_count = samples,
                                                .samples_per_pixel = samples,
                                                .branch_count = 1,
                                                .max_depth = 6,
                                                .light_samples = 1,
                                                .light_rays = rays});
    Estimate estimate;
    for (std::size_t pixel = 0; pixel < NEARLIGHT_PACKET_SIZE; ++pixel) {
        double sum = 0;
        double squares = 0;
        for (std::size_t i = 0; i < samples; ++i) {
            const double value = found.vertices[i * NEARLIGHT_PACKET_SIZE + pixel].camera_light.y;
            sum += value / samples;
            squares += value * value / samples;
        }
        estimate.mean += sum / NEARLIGHT_PACKET_SIZE;
        estimate.variance += (squares - sum * sum) / NEARLIGHT_PACKET_SIZE;
    }
    return estimate;
}

TEST_F(CameraLightRaysTest, TheyLowerTheNoiseAndKeepTheMean) {
    constexpr uint kSamples = 4096;
    for (const bool is_coated : {false, true}) {
        const Scene scene = lamp_and_sky_over_rough_floor(is_coated);
        on_each_ray_tree([&](Device& device) {
            Shooting shooting(device, scene, NEARLIGHT_TILE_SIZE, NEARLIGHT_TILE_SIZE);
            const Estimate one = seen_light(shooting, 1, kSamples);
            const Estimate many = seen_light(shooting, 8, kSamples);
            EXPECT_GT(one.mean, 0.02);
            EXPECT_NEAR(many.mean, one.mean, 0.01 * one.mean) << "coated: " << is_coated;
            EXPECT_LT(many.variance, (is_coated ? 0.9 : 0.6) * one.variance) << "coated: " << is_coated;
        });
    }
}

}  // namespace
}  // namespace nearlight::core
