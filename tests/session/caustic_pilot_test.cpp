// SPDX-License-Identifier: Apache-2.0
#include "host/session/caustic_pilot.h"

#include <gtest/gtest.h>

#include "host/reference/test_rooms.h"
#include "host/scene/material_model.h"
#include "host/session/session.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class CausticPilotTest : public test::DeviceTest {};

bool aims(Device& device, Scene scene) {
    set_camera(scene, {-1.5, 1, 0}, {0, 0, 0}, 60);
    Session session(device, scene);
    return session.look(scene.camera, {.width = 64, .height = 64}, 3).aims_at_caustics;
}

TEST_F(CausticPilotTest, AimingPaysBesideAMirror) {
    on_each_device([](Device& device) { EXPECT_TRUE(aims(device, make_mirror_corner().scene)); });
}

TEST_F(CausticPilotTest, WithoutMirrorsNothingIsAimedAt) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        scene.materials[1] = lambertian({0.5f, 0.5f, 0.5f});
        EXPECT_FALSE(aims(device, scene));
    });
}

/// Where lamps are in every direction, all rays over a mirror meet one.
TEST_F(CausticPilotTest, AimingDoesNotPayWhereLampsFillTheView) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(1.0f);
        add_inward_sphere(scene, 50, 1, add_two_sided(scene, lamp));
        EXPECT_FALSE(aims(device, scene));
    });
}

}  // namespace
}  // namespace nearlight::core
