// SPDX-License-Identifier: Apache-2.0
#include "host/scene/pinhole_camera.h"

#include <gtest/gtest.h>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

Vec3 direction(const PinholeCamera& camera, float x, float y) {
    return normalize(camera.corner + camera.step_x * x + camera.step_y * y);
}

void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

TEST(PinholeCamera, LocalFrameHasXToTheLeftAndYUp) {
    SceneCamera camera;
    camera.fov_x_degrees = 90;
    const PinholeCamera pinhole = make_pinhole_camera(camera, 200, 100);
    EXPECT_EQ(pinhole.width, 200u);
    EXPECT_EQ(pinhole.height, 100u);
    expect_near(pinhole.origin, {0, 0, 0});
    expect_near(direction(pinhole, 100, 50), {0, 0, 1});
    expect_near(direction(pinhole, 0, 50), normalize({1, 0, 1}));
    expect_near(direction(pinhole, 200, 50), normalize({-1, 0, 1}));
    expect_near(direction(pinhole, 0, 0), normalize({1, 0.5f, 1}));
    expect_near(direction(pinhole, 100, 100), normalize({0, -0.5f, 1}));
}

TEST(PinholeCamera, SeesAKnownPointWhereItIs) {
    // The camera is at (10, 2, −3) and looks along +X with +Y up, so the world's −Z is to the left.
    SceneCamera camera;
    camera.to_world = look_at({10, 2, -3}, {20, 2, -3}, {0, 1, 0});
    camera.fov_x_degrees = 2 * 45;
    const PinholeCamera pinhole = make_pinhole_camera(camera, 400, 300);
    // The point is 10 m ahead, 5 m to the left and 2.5 m up, so it is half way to the left edge and a third
    // of the way to the top.
    expect_near(direction(pinhole, 100, 100), normalize(Vec3{20, 4.5f, -8} - Vec3{10, 2, -3}));
}

TEST(PinholeCamera, FieldOfViewIsHorizontalAlsoInAPortrait) {
    SceneCamera camera;
    camera.fov_x_degrees = 60;
    const PinholeCamera pinhole = make_pinhole_camera(camera, 50, 150);
    EXPECT_NEAR(dot(direction(pinhole, 0, 75), direction(pinhole, 50, 75)), 0.5f, 1e-5f);
    EXPECT_NEAR(length(pinhole.step_x), length(pinhole.step_y), 1e-6f);
}

TEST(PinholeCamera, MirroringTransformMirrorsThePicture) {
    SceneCamera camera;
    camera.to_world = look_at({1, 2, 3}, {4, 1, -2}, {0, 1, 0});
    const PinholeCamera plain = make_pinhole_camera(camera, 64, 48);
    camera.to_world = camera.to_world * scaling(-1, 1, 1);
    const PinholeCamera mirrored = make_pinhole_camera(camera, 64, 48);
    expect_near(direction(plain, 10, 5), direction(mirrored, 54, 5));
}

TEST(PinholeCamera, RefusesWhatHasNoPicture) {
    SceneCamera camera;
    EXPECT_THROW(make_pinhole_camera(camera, 0, 10), Error);
    EXPECT_THROW(make_pinhole_camera(camera, 10, -1), Error);
    camera.fov_x_degrees = 180;
    EXPECT_THROW(make_pinhole_camera(camera, 10, 10), Error);
}

}  // namespace
}  // namespace nearlight::core
