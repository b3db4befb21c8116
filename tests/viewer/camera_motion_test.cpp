// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

constexpr float kQuarter = std::numbers::pi_v<float> / 2;
const Box kRoom{{-2, -1, -3}, {2, 1, 3}};

/// At the origin, looks along −Z, and turns about a point 2 m ahead.
FreeCamera camera() {
    return {
        .origin = {0, 0, 0}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .pivot_distance = 2, .fov_degrees = 90};
}

void expect_same(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

TEST(CameraMotion, BeginsWithTheScenesCamera) {
    const CameraPose pose{
        .origin = {0, 0.5f, 5}, .target = {0, 0.5f, 4}, .up = Vec3{0.1f, 0.9f, 0}, .fov_x_degrees = 50};
    const FreeCamera free = free_camera(pose, kRoom);
    expect_same(free.origin, {0, 0.5f, 5});
    expect_same(free.forward, {0, 0, -1});
    expect_same(free.up, {0, 1, 0});
    EXPECT_FLOAT_EQ(free.pivot_distance, 5);
    const CameraPose back = pose_of(free);
    expect_same(back.origin, pose.origin);
    expect_same(back.target, {0, 0.5f, 0});
    EXPECT_EQ(back.fov_x_degrees, pose.fov_x_degrees);
}

TEST(CameraMotion, KnowsScenesWhoseZIsUp) {
    const CameraPose pose{.origin = {0, -3, 1}, .target = {0, 0, 0.5f}, .up = Vec3{0, 0.2f, 0.95f}};
    expect_same(free_camera(pose, kRoom).up, {0, 0, 1});
    expect_same(free_camera({.origin = {}, .target = {1, 0, 0}, .up = Vec3{0, 0, -1}}, kRoom).up, {0, 0, -1});
}

/// Without surfaces the box of the scene is inside out.
TEST(CameraMotion, AnEmptySceneHasAPivotToo) {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    const Box empty{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    const FreeCamera free = free_camera({.origin = {0, 0, 0}, .target = {0, 0, 1}}, empty);
    EXPECT_GT(free.pivot_distance, 0.0f);
    EXPECT_TRUE(std::isfinite(free.pivot_distance));
    EXPECT_GT(walking_speed(empty), 0.0f);
}

TEST(CameraMotion, OrbitsKeepThePivotInTheMiddle) {
    const FreeCamera turned = orbit(camera(), kQuarter, 0);
    expect_same(turned.origin, {2, 0, -2});
    expect_same(turned.forward, {-1, 0, 0});
    expect_same(turned.origin + turned.forward * turned.pivot_distance, {0, 0, -2});
    const FreeCamera above = orbit(camera(), 0, kQuarter / 2);
    EXPECT_GT(above.origin.y, 1.0f);
    EXPECT_LT(above.forward.y, 0.0f);
}

TEST(CameraMotion, LooksAboutOnTheSpot) {
    const FreeCamera turned = look_about(camera(), kQuarter, 0);
    expect_same(turned.origin, {0, 0, 0});
    expect_same(turned.forward, {1, 0, 0});
    expect_same(look_about(camera(), 0, kQuarter / 2).forward, normalize({0, 1, -1}));
}

TEST(CameraMotion, NeverTurnsOverThePoles) {
    FreeCamera high = camera();
    for (int i = 0; i < 100; ++i) {
        high = look_about(high, 0.3f, 0.5f);
    }
    EXPECT_GT(high.forward.y, 0.99f);
    EXPECT_LT(high.forward.y, 1.0f);
    EXPECT_NEAR(length(right_of(high)), 1.0f, 1e-4f);
    for (int i = 0; i < 100; ++i) {
        high = orbit(high, -0.3f, 0.5f);
    }
    EXPECT_LT(high.forward.y, -0.99f);
    EXPECT_NEAR(length(high.forward), 1.0f, 1e-4f);
}

TEST(CameraMotion, WalksAlongItsOwnAxes) {
    expect_same(walk(camera(), 1, 0, 0).origin, {1, 0, 0});
    expect_same(walk(camera(), 0, 2, 0).origin, {0, 2, 0});
    expect_same(walk(camera(), 0, 0, 3).origin, {0, 0, -3});
    expect_same(walk(look_about(camera(), kQuarter, 0), 1, 0, 0).origin, {0, 0, 1});
}

/// With a field of view of 90 degrees the picture is 4 m wide at the pivot.
TEST(CameraMotion, PansByThePicturesWidth) {
    expect_same(pan(camera(), 0.25f, 0).origin, {1, 0, 0});
    expect_same(pan(camera(), 0, 0.5f).origin, {0, 2, 0});
}

TEST(CameraMotion, ApproachesWithoutArriving) {
    const FreeCamera near = approach(camera(), 2);
    expect_same(near.origin, {0, 0, -1});
    EXPECT_FLOAT_EQ(near.pivot_distance, 1);
    const FreeCamera nearest = approach(camera(), 1e30f);
    EXPECT_GT(nearest.pivot_distance, 0.0f);
    expect_same(approach(camera(), 0.5f).origin, {0, 0, 2});
}

TEST(CameraMotion, ThePivotDoesNotChangeThePicture) {
    EXPECT_TRUE(shows_same(camera(), with_pivot(camera(), 3)));
    EXPECT_FALSE(shows_same(camera(), walk(camera(), 0, 0, 1e-3f)));
    EXPECT_FALSE(shows_same(camera(), look_about(camera(), 1e-3f, 0)));
}

}  // namespace
}  // namespace nearlight::viewer
