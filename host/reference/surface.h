// SPDX-License-Identifier: Apache-2.0
// What a ray finds where it hits a triangle.
#pragma once

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Surface {
    Vec3 position;          ///< on the triangle
    Vec3 geometric_normal;  ///< unit, towards the side that the ray came from
    Vec3 shading_normal;    ///< unit, on the same side
    float u = 0.0f;         ///< texture coordinates
    float v = 0.0f;
    const Material* material = nullptr;
    bool front = true;  ///< the ray came from the triangle's front

    /// Whether this side reflects at all.
    [[nodiscard]] bool reflects() const {
        return front || (material->flags & NEARLIGHT_MATERIAL_TWO_SIDED) != 0u;
    }
};

/// @param direction of the ray that hit.
Surface surface_at(const Scene& scene, const BvhHit& hit, Vec3 direction);

}  // namespace nearlight::core
