// SPDX-License-Identifier: Apache-2.0
// A scene with every kind of light, for tests of passes.
#pragma once

#include "tests/support/small_scenes.h"

namespace nearlight::core::test {

struct YardView {
    int width;
    int height;
    double fov_degrees;
};

/// A floor and a wall under a lamp and a sky.
inline Scene yard(const YardView& view) {
    using namespace small_scenes;
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, grey);
    add_quad(scene, {-2, -1, 1}, {0, 2, 0}, {4, 0, 0}, grey);
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    scene.environment = {.width = 1, .height = 1, .radiance = {{0.3f, 0.4f, 0.5f}}, .to_world = {}};
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, view.fov_degrees);
    scene.camera.width = view.width;
    scene.camera.height = view.height;
    return scene;
}

}  // namespace nearlight::core::test
