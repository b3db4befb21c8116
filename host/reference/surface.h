// SPDX-License-Identifier: Apache-2.0
// The surface that a ray finds where it hits a triangle.
#pragma once

#include <array>

#include "host/bvh/bvh.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Surface {
    Vec3 position;                  ///< on the triangle
    std::array<Vec3, 3> corners{};  ///< of the triangle
    Vec3 geometric_normal;          ///< unit vector, on the side that the ray came from
    Vec3 front_normal;  ///< the unit shading normal as the vertices have it, which says where the front is
    Vec3 along_u;       ///< derivatives of the position by the texture coordinates; zero where these do not
    Vec3 along_v;       ///< span the triangle
    Vec3 vertex_color{1, 1, 1};
    float u = 0.0f;  ///< texture coordinates
    float v = 0.0f;
    std::array<float, 2> second_uv{0, 0};
    const Material* material = nullptr;
    bool front = true;  ///< the ray came from the triangle's front

    /// Distance (m) by which rays start off it, in a scene whose bounds have these sides (m).
    [[nodiscard]] float stand_off(Vec3 scene_size) const {
        return triangle_stand_off(corners[0], corners[1], corners[2], scene_size);
    }
    /// The point from which rays start on the side of the unit vector `side`, the normal or the opposite.
    [[nodiscard]] Vec3 off(Vec3 side, Vec3 scene_size) const {
        return position + side * stand_off(scene_size);
    }
};

/// The surface at a hit of a ray with the given direction.
Surface surface_at(const Scene& scene, const BvhHit& hit, Vec3 direction);

/// The value of a parameter at the surface.
Vec3 value_at(const Scene& scene, const Surface& surface, const Parameter& parameter);

}  // namespace nearlight::core
