// SPDX-License-Identifier: Apache-2.0
#include "host/session/openings.h"

#include "host/scene/material_model.h"
#include "host/session/session.h"
#include "tests/support/device_fixture.h"
#include "tests/support/house_on_grounds.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class OpeningsTest : public test::DeviceTest {};

std::vector<Opening> openings_of(Device& device, const Scene& scene) {
    return Session(device, scene).look(scene.camera, {}, 3).openings;
}

/// All openings are in the window and look outwards, and their shares add up to 1.
void expect_window(const std::vector<Opening>& openings) {
    ASSERT_FALSE(openings.empty());
    ASSERT_LE(openings.size(), NEARLIGHT_MAX_OPENINGS);
    float shares = 0;
    for (const Opening& opening : openings) {
        EXPECT_LT(length(opening.center - test::kHouseWindow), 1.0f);
        EXPECT_LT(opening.radius, 0.8f);
        EXPECT_GT(opening.radius, 0.05f);
        EXPECT_GT(opening.outwards.z, 0.5f);
        EXPECT_NEAR(length(opening.outwards), 1.0f, 1e-5f);
        shares += opening.share;
    }
    EXPECT_NEAR(shares, 1.0f, 1e-5f);
}

TEST_F(OpeningsTest, AWindowIsOne) {
    on_each_device([](Device& device) { expect_window(openings_of(device, test::house_on_grounds(1))); });
}

TEST_F(OpeningsTest, AWindowWithPanesIsOne) {
    for (const Material& glass : {thin_dielectric_material(1.5), dielectric_material(1.5)}) {
        Scene scene = test::house_on_grounds(1);
        const uint pane = add_material(scene, glass);
        add_quad(scene, {-0.5f, 1.5f, 2.02f}, {1, 0, 0}, {0, 1, 0}, pane);
        add_quad(scene, {-0.5f, 1.5f, 2.0f}, {0, 1, 0}, {1, 0, 0}, pane);
        on_each_device([&](Device& device) { expect_window(openings_of(device, scene)); });
    }
}

/// What the camera sees has no view of the window, but surfaces beside it have.
TEST_F(OpeningsTest, AWindowAroundACornerIsOne) {
    Scene scene = test::house_on_grounds(1);
    const uint screen = add_two_sided(scene, lambertian({0.6f, 0.6f, 0.6f}));
    add_quad(scene, {-2, 0, 0.5f}, {3, 0, 0}, {0, 4, 0}, screen);
    set_camera(scene, {-1.5, 2, 0.3}, {-1.7, 2, -2}, 30);
    on_each_device([&](Device& device) { expect_window(openings_of(device, scene)); });
}

/// A directional light comes from afar as the sky does, and the camera may look out of the window at the
/// grounds.
TEST_F(OpeningsTest, GroundsBehindTheWindowAreNone) {
    Scene scene = test::house_on_grounds(1);
    scene.environment = {};
    add_directional_light(scene, {0, -1, -1}, {1, 1, 1});
    set_camera(scene, {0, 2, -1.5}, {0, 1.5, 2}, 80);
    on_each_device([&](Device& device) { expect_window(openings_of(device, scene)); });
}

TEST_F(OpeningsTest, AClosedRoomHasNone) {
    on_each_device(
        [](Device& device) { EXPECT_TRUE(openings_of(device, test::house_on_grounds(0)).empty()); });
}

TEST_F(OpeningsTest, WithoutLightFromAfarThereIsNone) {
    Scene scene = test::house_on_grounds(1);
    scene.environment = {};
    add_point_light(scene, {0, 3, 0}, {1, 1, 1});
    on_each_device([&](Device& device) { EXPECT_TRUE(openings_of(device, scene).empty()); });
}

TEST_F(OpeningsTest, OpenCountryHasNone) {
    Scene scene = test::house_on_grounds(1);
    set_camera(scene, {10, 6, 10}, {0, 1, 0}, 60);
    on_each_device([&](Device& device) { EXPECT_TRUE(openings_of(device, scene).empty()); });
}

}  // namespace
}  // namespace nearlight::core
