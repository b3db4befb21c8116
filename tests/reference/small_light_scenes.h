// SPDX-License-Identifier: Apache-2.0
// Scenes in which the light is known, for tests of the path tracer.
#pragma once

#include "tests/support/small_scenes.h"

namespace nearlight::core::small_scenes {

/// A scene in which every surface has albedo ρ and emits radiance 1, so paths of depth d bring exactly ρ^d.
inline Scene furnace(float albedo) {
    Scene scene;
    Material wall = lambertian({albedo, albedo, albedo});
    wall.emission = parameter_of(1.0f);
    add_inward_sphere(scene, 2.0f, 1, add_material(scene, wall));
    set_camera(scene, {0.3, 0.2, 0}, {0, 0, 1}, 60);
    return scene;
}

/// Two squares of side 2, facing each other at distance 1, and a point light between them.
inline Scene facing_squares(float albedo) {
    Scene scene;
    const uint material = add_material(scene, lambertian({albedo, albedo, albedo}));
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, material);
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, material);
    add_point_light(scene, {0.2f, 0.6f, 0.1f}, {1, 1, 1});
    set_camera(scene, {0.0, 0.5, 0.0}, {0.3, 0.0, 0.2}, 0.05);
    return scene;
}

}  // namespace nearlight::core::small_scenes
