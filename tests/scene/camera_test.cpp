// SPDX-License-Identifier: Apache-2.0
#include "host/scene/camera.h"

#include <gtest/gtest.h>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

Vec3 direction(const Camera& camera, float x, float y) {
    return normalize(camera.corner + camera.step_x * x + camera.step_y * y);
}

void expect_same(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-5f);
    EXPECT_NEAR(a.y, b.y, 1e-5f);
    EXPECT_NEAR(a.z, b.z, 1e-5f);
}

TEST(Camera, LocalFrameHasXToTheLeftAndYUp) {
    SceneCamera camera;
    camera.fov_x_degrees = 90;
    const Camera pinhole = make_camera(camera, 200, 100);
    EXPECT_EQ(pinhole.width, 200u);
    EXPECT_EQ(pinhole.height, 100u);
    expect_same(pinhole.origin, {0, 0, 0});
    expect_same(direction(pinhole, 100, 50), {0, 0, 1});
    expect_same(direction(pinhole, 0, 50), normalize({1, 0, 1}));
    expect_same(direction(pinhole, 200, 50), normalize({-1, 0, 1}));
    expect_same(direction(pinhole, 0, 0), normalize({1, 0.5f, 1}));
    expect_same(direction(pinhole, 100, 100), normalize({0, -0.5f, 1}));
}

TEST(Camera, SeesAKnownPointWhereItIs) {
    // The camera is at (10, 2, −3) and looks along +X with +Y up, so the world's −Z is to the left.
    SceneCamera camera;
    camera.to_world = look_at({10, 2, -3}, {20, 2, -3}, {0, 1, 0});
    camera.fov_x_degrees = 2 * 45;
    const Camera pinhole = make_camera(camera, 400, 300);
    // The point is 10 m ahead, 5 m to the left and 2.5 m up, so it is half way to the left edge and a third
    // of the way to the top.
    expect_same(direction(pinhole, 100, 100), normalize(Vec3{20, 4.5f, -8} - Vec3{10, 2, -3}));
}

TEST(Camera, FieldOfViewIsHorizontalAlsoInAPortrait) {
    SceneCamera camera;
    camera.fov_x_degrees = 60;
    const Camera pinhole = make_camera(camera, 50, 150);
    EXPECT_NEAR(dot(direction(pinhole, 0, 75), direction(pinhole, 50, 75)), 0.5f, 1e-5f);
    EXPECT_NEAR(length(pinhole.step_x), length(pinhole.step_y), 1e-6f);
}

TEST(Camera, MirroringTransformMirrorsThePicture) {
    SceneCamera camera;
    camera.to_world = look_at({1, 2, 3}, {4, 1, -2}, {0, 1, 0});
    const Camera plain = make_camera(camera, 64, 48);
    camera.to_world = camera.to_world * scaling(-1, 1, 1);
    const Camera mirrored = make_camera(camera, 64, 48);
    expect_same(direction(plain, 10, 5), direction(mirrored, 54, 5));
}

TEST(Camera, OrthographicRaysAreParallelAndAsFarApartAsPixelsAre) {
    SceneCamera camera;
    camera.kind = CameraKind::orthographic;
    camera.to_world = look_at({1, 2, 3}, {4, 1, -2}, {0, 1, 0}) * scaling(3, 3, 2);
    camera.near_clip = 0.5;
    camera.far_clip = 4.0;
    const Camera made = make_camera(camera, 60, 30);
    EXPECT_NEAR(length(made.forward), 1.0f, 1e-6f);
    expect_same(made.forward, normalize(Vec3{3, -1, -5}));
    EXPECT_NEAR(length(made.step_x), 6.0f / 60, 1e-6f);  // 2 local units, scaled by 3
    EXPECT_NEAR(length(made.step_y), 6.0f / 60, 1e-6f);
    expect_same(made.corner + made.step_x * 30 + made.step_y * 15, {0, 0, 0});
    EXPECT_FLOAT_EQ(made.near_clip, 1.0f);  // scaled by 2, unlike the distance to the far one
    EXPECT_FLOAT_EQ(made.far_clip, 4.5f);
}

TEST(Camera, FilmPositionIsThatOfTheRayThroughThePoint) {
    SceneCamera camera;
    camera.to_world = look_at({1, 2, 3}, {4, 1, -2}, {0, 1, 0});
    camera.width = 90;
    camera.height = 40;
    camera.center_x = 0.2;
    camera.center_y = -0.3;
    camera.film_part = 0.4;
    for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
        camera.kind = kind;
        const Camera made = make_camera(camera, camera.width, camera.height);
        const Vec3 d = made.corner + made.step_x * 20 + made.step_y * 31;
        const bool is_parallel = kind == CameraKind::orthographic;
        const Vec3 point = is_parallel ? made.origin + d + made.forward * 5 : made.origin + d * 5;
        const auto found = film_position(camera, point);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->x, 20.0, 1e-3);
        EXPECT_NEAR(found->y, 31.0, 1e-3);
        EXPECT_NEAR(found->distance, is_parallel ? 5.0 : static_cast<double>(length(d)) * 5, 1e-4);
        EXPECT_FALSE(film_position(camera, made.origin - made.forward));
    }
}

TEST(Camera, PosesPutItWhereTheySay) {
    SceneCamera camera;
    camera.to_world = look_at({10, 2, -3}, {20, 2, -3}, {0, 1, 0}) * scaling(2, 3, 2);
    camera.aperture_radius = 0.5;
    const CameraPose pose = pose_of(camera);
    EXPECT_FLOAT_EQ(pose.origin.x, 10.0f);
    EXPECT_FLOAT_EQ(pose.target.x, 11.0f);
    EXPECT_FLOAT_EQ(pose.up->y, 1.0f);
    EXPECT_EQ(pose.fov_x_degrees, camera.fov_x_degrees);
    const SceneCamera same = posed(camera, pose);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(same.to_world.m[i], camera.to_world.m[i], 1e-6) << i;
    }

    const SceneCamera moved = posed(camera, {.origin = {0, 0, 1}, .target = {0, 0, 0}, .fov_x_degrees = 70});
    expect_same(transform_point(moved.to_world, {0, 0, 0}), {0, 0, 1});
    expect_same(transform_vector(moved.to_world, {0, 0, 1}), {0, 0, -2});  // the lens keeps its scale
    expect_same(transform_vector(moved.to_world, {0, 1, 0}), {0, 3, 0});   // upwards as before
    EXPECT_EQ(moved.fov_x_degrees, 70.0);
    EXPECT_EQ(moved.aperture_radius, 0.5);
}

TEST(Camera, PosesOfOrthographicCamerasKeepTheirScaleUntilTheyHaveAFieldOfView) {
    SceneCamera camera;
    camera.kind = CameraKind::orthographic;
    camera.to_world = scaling(4, 4, 1);
    CameraPose pose = pose_of(camera);
    EXPECT_FALSE(pose.fov_x_degrees);
    pose.target = {1, 0, 0};
    const SceneCamera aside = posed(camera, pose);
    EXPECT_EQ(aside.kind, CameraKind::orthographic);
    expect_same(transform_vector(aside.to_world, {1, 0, 0}), {0, 0, -4});
    pose.fov_x_degrees = 50;
    const SceneCamera perspective = posed(camera, pose);
    EXPECT_EQ(perspective.kind, CameraKind::perspective);
    expect_same(transform_vector(perspective.to_world, {1, 0, 0}), {0, 0, -1});
}

TEST(Camera, PosesOfCamerasThatMirrorMirror) {
    SceneCamera camera;
    camera.to_world = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}) * scaling(-1, 1, 1);
    const SceneCamera same = posed(camera, pose_of(camera));
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(same.to_world.m[i], camera.to_world.m[i], 1e-6) << i;
    }
}

TEST(Camera, RefusesWhatHasNoPicture) {
    SceneCamera camera;
    EXPECT_THROW(make_camera(camera, 0, 10), Error);
    EXPECT_THROW(make_camera(camera, 10, -1), Error);
    camera.fov_x_degrees = 180;
    EXPECT_THROW(make_camera(camera, 10, 10), Error);
}

}  // namespace
}  // namespace nearlight::core
