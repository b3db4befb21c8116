// SPDX-License-Identifier: Apache-2.0
// Compares the renderer with the reference path tracer where light comes through panes, masks and clear
// glass.
#include <gtest/gtest.h>

#include "tests/session/agreement.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr float kGlassClampRadius = 0.15f;

/// VPLs behind veils that the camera looks through have some bounces too many (docs/method.md, "Depth"),
/// which a larger limit makes too weak to see.
void expect_glass_agreement(Device& device, const Scene& scene, SamplerKind sampler) {
    for (const bool compensate : {false, true}) {
        test::expect_agreement(device, scene, sampler, kGlassClampRadius, compensate, 14);
    }
}

class GlassAgreement : public test::DeviceTest {};

/// A closed room of 2 × 2 × 2 with a block on its floor. Panes and masks hang under the ceiling, and a second
/// mask stands on the floor.
Scene room_with_veils() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.6f, 0.6f, 0.6f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);   // ceiling
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);   // back
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);  // front, behind the camera
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, white);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
    Material pane = thin_dielectric_material(1.5);
    pane.transmission = parameter_of(Vec3{0.9f, 0.8f, 0.5f});
    const uint glass = add_material(scene, pane);
    const uint green = add_two_sided(scene, lambertian({0.1f, 0.5f, 0.1f}));
    const uint mask = add_material(scene, mask_material(parameter_of(0.4f), green));
    add_quad(scene, {-0.9f, 0.5f, -0.9f}, {0, 0, 1.8f}, {0.8f, 0, 0}, glass);
    add_quad(scene, {0.1f, 0.5f, -0.9f}, {0, 0, 1.8f}, {0.8f, 0, 0}, mask);
    add_quad(scene, {-0.5f, -1, 0.3f}, {0, 0.8f, 0}, {0.9f, 0, 0.3f}, mask);
    set_camera(scene, {0.1, -0.1, -0.9}, {0, -0.3, 1}, 75);
    scene.camera.width = test::kAgreementSize;
    scene.camera.height = test::kAgreementSize;
    return scene;
}

Scene lamp_behind_veils() {
    Scene scene = room_with_veils();
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{12, 12, 14});
    add_quad(scene, {-0.2f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, add_material(scene, lamp));
    return scene;
}

/// Smooth and rough metal in the room, which mirror the lamp.
Scene lamp_behind_veils_over_metal() {
    Scene scene = lamp_behind_veils();
    Material metal = conductor_material({0.2f, 0.9f, 1.1f}, {3.9f, 2.5f, 2.1f});
    metal.roughness = parameter_of(0.2f);
    add_quad(scene, {-0.9f, -0.95f, -0.3f}, {0, 0, 0.8f}, {0.5f, 0, 0}, add_material(scene, metal));
    return scene;
}

/// A slab of solid glass, a pane and masks under a point light and a small lamp.
Scene clear_glass() {
    Scene scene = room_with_veils();
    scene.clear_glass = true;
    Material glass = dielectric_material(1.5);
    glass.transmission = parameter_of(Vec3{0.8f, 0.9f, 0.9f});
    const uint body = add_material(scene, glass);
    add_quad(scene, {-0.8f, -0.4f, -0.4f}, {0, 0, 0.8f}, {0.8f, 0, 0}, body);
    add_quad(scene, {-0.8f, -0.5f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, body);
    add_point_light(scene, {0.3f, 0.8f, 0.2f}, {1.0f, 0.9f, 0.8f});
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{3, 3, 3});
    add_quad(scene, {-0.7f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, add_material(scene, lamp));
    return scene;
}

/// The pane and the masks let the light of the point light pass, as in glTF files, and the slab does not.
Scene open_veils() {
    Scene scene = clear_glass();
    scene.clear_glass = false;
    scene.open_veils = true;
    return scene;
}

TEST_F(GlassAgreement, CompleteWithALampBehindVeils) {
    on_each_device(
        [](Device& d) { expect_glass_agreement(d, lamp_behind_veils(), SamplerKind::close_range); });
}
/// Rays take away VPLs' light over paths that are too long for what the camera sees through veils, including
/// the light that reached the VPLs through veils.
TEST_F(GlassAgreement, CompleteWithALampBehindVeilsAtAFewEdges) {
    on_each_device([](Device& d) {
        for (const uint max_depth : {5u, 6u}) {
            SCOPED_TRACE(max_depth);
            test::expect_agreement(d, lamp_behind_veils(), SamplerKind::close_range, kGlassClampRadius, true,
                                   max_depth, 2048);
        }
    });
}
TEST_F(GlassAgreement, InstantRadiosityWithALampBehindVeilsOverMetal) {
    on_each_device([](Device& d) {
        expect_glass_agreement(d, lamp_behind_veils_over_metal(), SamplerKind::instant_radiosity);
    });
}
TEST_F(GlassAgreement, LocalWithALampBehindVeils) {
    on_each_device([](Device& d) { expect_glass_agreement(d, lamp_behind_veils(), SamplerKind::local); });
}
TEST_F(GlassAgreement, CompleteThroughClearGlass) {
    on_each_device([](Device& d) { expect_glass_agreement(d, clear_glass(), SamplerKind::close_range); });
}
TEST_F(GlassAgreement, CompleteThroughOpenVeils) {
    on_each_device([](Device& d) { expect_glass_agreement(d, open_veils(), SamplerKind::close_range); });
}
TEST_F(GlassAgreement, InstantRadiosityThroughClearGlass) {
    on_each_device(
        [](Device& d) { expect_glass_agreement(d, clear_glass(), SamplerKind::instant_radiosity); });
}

}  // namespace
}  // namespace nearlight::core
