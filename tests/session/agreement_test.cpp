// SPDX-License-Identifier: Apache-2.0
// Compares the renderer with the reference path tracer, which shares no sampling code with it. Both compute
// the same definition and must make the same picture.
#include <gtest/gtest.h>

#include "tests/session/agreement.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr float kClampRadius = 0.15f;

/// A closed room of 2 × 2 × 2 with a red and a green wall and a block on the floor, but without a light.
Scene room() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint red = add_material(scene, lambertian({0.6f, 0.1f, 0.1f}));
    const uint green = add_material(scene, lambertian({0.1f, 0.5f, 0.1f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);   // ceiling
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);   // back
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);  // front, behind the camera
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, green);
    const Vec3 corner{-0.2f, -1, 0.1f};
    add_quad(scene, corner + Vec3{0, 0.8f, 0}, {0, 0, 0.5f}, {0.6f, 0, 0.1f}, white);  // top
    add_quad(scene, corner, {0, 0.8f, 0}, {0.6f, 0, 0.1f}, white);
    add_quad(scene, corner + Vec3{0.6f, 0, 0.1f}, {0, 0.8f, 0}, {0, 0, 0.5f}, white);
    add_quad(scene, corner, {0, 0, 0.5f}, {0, 0.8f, 0}, white);
    set_camera(scene, {0.1, 0.2, -0.9}, {0, -0.3, 1}, 70);
    scene.camera.width = test::kAgreementSize;
    scene.camera.height = test::kAgreementSize;
    return scene;
}

Scene room_with_point_light() {
    Scene scene = room();
    add_point_light(scene, {0.3f, 0.7f, -0.2f}, {1.0f, 0.9f, 0.8f});
    return scene;
}

Scene room_with_area_light() {
    Scene scene = room();
    Material lamp = lambertian({0.0f, 0.0f, 0.0f});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-0.3f, 0.98f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    return scene;
}

Scene room_with_window() {
    Scene scene = room();
    // The room has no ceiling and is under a sky that is brighter on one side.
    scene.triangles.erase(scene.triangles.begin() + 2, scene.triangles.begin() + 4);
    scene.environment = {.width = 2,
                         .height = 2,
                         .radiance = {{2, 2, 2}, {0.5f, 0.5f, 1}, {0.1f, 0.1f, 0.1f}, {0, 0, 0}},
                         .to_world = {}};
    return scene;
}

class Agreement : public test::DeviceTest {};

TEST_F(Agreement, InstantRadiosityWithPointLight) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_point_light(), SamplerKind::instant_radiosity, kClampRadius);
    });
}
TEST_F(Agreement, InstantRadiosityWithAreaLight) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_area_light(), SamplerKind::instant_radiosity, kClampRadius);
    });
}
TEST_F(Agreement, InstantRadiosityUnderSky) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_window(), SamplerKind::instant_radiosity, kClampRadius);
    });
}
TEST_F(Agreement, CompleteWithPointLight) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_point_light(), SamplerKind::close_range, kClampRadius);
    });
}
TEST_F(Agreement, CompleteWithAreaLight) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_area_light(), SamplerKind::close_range, kClampRadius);
    });
}
TEST_F(Agreement, CompleteUnderSky) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_window(), SamplerKind::close_range, kClampRadius);
    });
}
/// Among the samplers only this one makes a picture without a bounded geometry term.
TEST_F(Agreement, LocalWithoutClamp) {
    on_each_device(
        [](Device& d) { test::expect_agreement(d, room_with_point_light(), SamplerKind::local, 0.0f); });
}
/// With a single bounce, each local light is lit by lamps alone.
TEST_F(Agreement, LocalWithoutClampAtThreeEdges) {
    on_each_device([](Device& d) {
        test::expect_agreement(d, room_with_point_light(), SamplerKind::local, 0.0f, false, 3);
    });
}

}  // namespace
}  // namespace nearlight::core
