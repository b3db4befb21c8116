// SPDX-License-Identifier: Apache-2.0
// A room with a window on wide grounds under the sky, for tests of how light gets in.
#pragma once

#include "tests/support/small_scenes.h"

namespace nearlight::core::test {

inline const Vec3 kHouseWindow{0, 2, 2};  ///< the middle of the window, which faces +z

/// A wall with a normal along z that closes the room at `z`, with a hole of `hole` × `hole` in its middle.
inline void add_house_wall(Scene& scene, float z, float hole, uint material) {
    using namespace small_scenes;
    const float rim = 0.5f * (4 - hole);
    add_quad(scene, {-2, 0, z}, {4, 0, 0}, {0, rim, 0}, material);
    add_quad(scene, {-2, 4 - rim, z}, {4, 0, 0}, {0, rim, 0}, material);
    add_quad(scene, {-2, rim, z}, {rim, 0, 0}, {0, hole, 0}, material);
    add_quad(scene, {2 - rim, rim, z}, {rim, 0, 0}, {0, hole, 0}, material);
}

/// A room of 4 × 4 × 4 in the middle of a ground of 160 × 160, with a window of `window` × `window`. The
/// camera looks away from it.
inline Scene house_on_grounds(float window) {
    using namespace small_scenes;
    Scene scene;
    const uint wall = add_two_sided(scene, lambertian({0.6f, 0.6f, 0.6f}));
    add_house_wall(scene, -2, 0, wall);
    add_house_wall(scene, 2, window, wall);
    add_quad(scene, {-2, 0, -2}, {0, 4, 0}, {0, 0, 4}, wall);
    add_quad(scene, {2, 0, -2}, {0, 4, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-2, 4, -2}, {4, 0, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-80, 0, -80}, {160, 0, 0}, {0, 0, 160}, wall);
    set_constant_sky(scene, {1, 1, 1});
    set_camera(scene, {0, 2, 1.5}, {0, 2, -2}, 80);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

}  // namespace nearlight::core::test
