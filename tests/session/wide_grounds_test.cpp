// SPDX-License-Identifier: Apache-2.0
// The noise in a room does not depend on what is outside if nothing of that enters the room.
#include <gtest/gtest.h>

#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class WideGroundsTest : public test::DeviceTest {};

/// A closed room of 4 × 2.5 × 4 with a lamp and a table.
Scene lit_room() {
    Scene scene;
    const uint wall = add_two_sided(scene, lambertian({0.7f, 0.6f, 0.5f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{8, 8, 8});
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, wall);
    add_quad(scene, {-2, 2.5f, -2}, {4, 0, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-2, 0, -2}, {4, 0, 0}, {0, 2.5f, 0}, wall);
    add_quad(scene, {-2, 0, 2}, {0, 2.5f, 0}, {4, 0, 0}, wall);
    add_quad(scene, {-2, 0, -2}, {0, 2.5f, 0}, {0, 0, 4}, wall);
    add_quad(scene, {2, 0, -2}, {0, 0, 4}, {0, 2.5f, 0}, wall);
    add_quad(scene, {-0.6f, 0.7f, 0.2f}, {0, 0, 0.8f}, {1.2f, 0, 0}, wall);
    add_quad(scene, {-0.2f, 2.4f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, add_material(scene, lamp));
    set_camera(scene, {0.3, 1.5, -1.8}, {0, 0.7, 1}, 75);
    scene.camera.width = scene.camera.height = 16;
    return scene;
}

Scene lit_room_on_wide_grounds() {
    Scene scene = lit_room();
    add_quad(scene, {-100, -0.1f, -100}, {0, 0, 200}, {200, 0, 0},
             add_material(scene, lambertian({0.4f, 0.4f, 0.4f})));
    set_constant_sky(scene, {1, 1, 1});
    return scene;
}

/// The mean over pixels of the variance of indirect light over seeds, in units of its squared mean.
double relative_variance(Device& device, const Scene& scene) {
    Session session(device, scene);
    const RenderSettings settings{
        .view = {.range = 4.0f, .clamp_radius = 0.2f},
        .sampling = {.vpl_count = 200},
        .gather = {.samples_per_pixel = 1, .compensate = false, .indirect_only = true}};
    constexpr uint kSeeds = 12;
    const std::vector<Image> images = test::render_seeds(session, settings, 40, kSeeds);
    const auto channel = static_cast<std::size_t>(images[0].find_channel("indirect.G"));
    double relative = 0;
    for (int pixel = 0; pixel < 16 * 16; ++pixel) {
        double sum = 0;
        double squares = 0;
        for (const Image& image : images) {
            const double value = image.at(pixel % 16, pixel / 16, channel);
            sum += value;
            squares += value * value;
        }
        const double mean = sum / kSeeds;
        relative += (squares / kSeeds - mean * mean) / std::max(mean * mean, 1e-12) / (16 * 16);
    }
    return relative;
}

TEST_F(WideGroundsTest, LeaveTheNoiseInAClosedRoomAsItIs) {
    on_each_device([](Device& device) {
        const double room = relative_variance(device, lit_room());
        const double house = relative_variance(device, lit_room_on_wide_grounds());
        EXPECT_GT(room, 0.0);
        // The lamp keeps half of the walks, which alone is a factor of 2.
        EXPECT_LT(house, 6 * room);
    });
}

}  // namespace
}  // namespace nearlight::core
