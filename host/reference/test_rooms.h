// SPDX-License-Identifier: Apache-2.0
// Rooms in which the light is known.
#pragma once

#include "host/base/math.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// A closed room full of rough spheres, with a lamp and the same albedo everywhere. Light is lost only by
/// absorption.
Scene make_even_room(Vec3 albedo);

/// A room full of rough spheres in several colours, lit by point and spot lights only.
Scene make_delta_lit_room();

/// A floor at y = 0 beside a wall of perfect mirror at x = mirror_x, under a square lamp that shines down.
struct MirrorCorner {
    Scene scene;
    float mirror_x = 1.0f;
    Vec3 lamp{0, 1, 0};           ///< its centre
    float lamp_half_side = 0.1f;  ///< m
    float lamp_radiance = 10.0f;  ///< W/m²/sr, of each colour
};
MirrorCorner make_mirror_corner();

/// The inside of a sphere about a point light of 1 W/sr. Its irradiance is 1 / radius² everywhere, to within
/// the 2 ‰ by which flat triangles differ from the sphere.
Scene make_lit_sphere(float radius, float albedo);

}  // namespace nearlight::core
