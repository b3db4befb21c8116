// SPDX-License-Identifier: Apache-2.0
// The surface that a ray finds where it hits a triangle.
#pragma once

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Surface {
    Vec3 position;          ///< on the triangle
    Vec3 geometric_normal;  ///< unit vector, on the side that the ray came from
    Vec3 shading_normal;    ///< unit vector, on the side that the ray came from
    float u = 0.0f;         ///< texture coordinates
    float v = 0.0f;
    const Material* material = nullptr;
    bool front = true;  ///< the ray came from the triangle's front

    /// Whether the side that was hit reflects light.
    [[nodiscard]] bool reflects() const {
        return front || (material->flags & NEARLIGHT_MATERIAL_TWO_SIDED) != 0u;
    }
};

/// The surface at a hit of a ray with the given direction.
Surface surface_at(const Scene& scene, const BvhHit& hit, Vec3 direction);

}  // namespace nearlight::core
