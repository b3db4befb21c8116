// SPDX-License-Identifier: Apache-2.0
#include "host/session/sky_part.h"

#include "host/session/session.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class SkyPartTest : public test::DeviceTest {};

/// A wide floor that the camera sees from above.
Scene floor_under_sky() {
    Scene scene;
    const uint gray = add_two_sided(scene, lambertian({0.5f, 0.5f, 0.5f}));
    add_quad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, gray);
    scene.environment = patterned_map(4, 2);
    set_camera(scene, {0, 2, 0.5}, {0, 0, 0}, 30);
    return scene;
}

float part_of(Device& device, const Scene& scene) {
    Session session(device, scene);
    return session.look(scene.camera, {.width = 64, .height = 64}, 3).sky_part;
}

TEST_F(SkyPartTest, IsAllUnderAnOpenSky) {
    on_each_device([](Device& device) { EXPECT_EQ(part_of(device, floor_under_sky()), 1.0f); });
}

/// A high wall beside what the camera sees hides half of the sky.
TEST_F(SkyPartTest, IsHalfBesideAWall) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_sky();
        add_quad(scene, {-50, 0, -0.7f}, {0, 500, 0}, {100, 0, 0},
                 add_two_sided(scene, lambertian({0.5f, 0.5f, 0.5f})));
        EXPECT_NEAR(part_of(device, scene), 0.5, 0.05);
    });
}

TEST_F(SkyPartTest, IsNothingInAClosedBox) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_sky();
        add_inward_sphere(scene, 200, 1, add_two_sided(scene, lambertian({0.5f, 0.5f, 0.5f})));
        EXPECT_EQ(part_of(device, scene), 0.0f);
    });
}

TEST_F(SkyPartTest, IsNothingWithoutASky) {
    on_each_device([](Device& device) {
        Scene scene = floor_under_sky();
        scene.environment = {};
        add_point_light(scene, {0, 1, 0}, {1, 1, 1});
        EXPECT_EQ(part_of(device, scene), 0.0f);
    });
}

}  // namespace
}  // namespace nearlight::core
