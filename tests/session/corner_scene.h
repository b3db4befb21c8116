// SPDX-License-Identifier: Apache-2.0
// A scene in which much of the light comes from nearby.
#pragma once

#include "tests/support/small_scenes.h"

namespace nearlight::core::test {

/// Where three walls meet, under a lamp. Most of the light of the edges comes from nearby.
inline Scene corner() {
    using namespace small_scenes;
    Scene scene;
    const uint white = add_material(scene, lambertian({0.8f, 0.8f, 0.8f}));
    const uint red = add_material(scene, lambertian({0.7f, 0.2f, 0.1f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);   // back
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, red);     // on the side
    add_quad(scene, {-0.6f, 0.9f, -0.6f}, {0.8f, 0, 0}, {0, 0, 0.8f}, add_material(scene, lamp));
    set_camera(scene, {-0.6, 0.4, -0.9}, {1, -0.8, 1}, 60);
    scene.camera.width = scene.camera.height = 16;
    return scene;
}

}  // namespace nearlight::core::test
