// SPDX-License-Identifier: Apache-2.0
// Sculpture by signed distances: solids blended into one another, and the surface made triangles.
#pragma once

#include <functional>
#include <vector>

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// Distance to a surface in metres, negative inside; may be off by a third, but not in its sign.
using Distance = std::function<float(Vec3)>;

Distance solid_ellipsoid(Vec3 center, Vec3 radii);
/// Two balls and the cone that touches both, its axis from a to b.
Distance solid_cone(Vec3 a, Vec3 b, float radius_a, float radius_b);
/// A ball with a spiral groove about the axis through its centre, `turns` turns from the pole to the equator.
Distance solid_curl(Vec3 center, Vec3 axis, float radius, float turns);
Distance solid_box(Vec3 center, Vec3 half, float rounding);

class Carving {
  public:
    /// Blends over about `blend` metres.
    void add(Distance part, float blend);
    void cut(Distance part, float blend);
    /// Both sides of the plane x = 0: makes and adds the part for x and then for −x.
    void add_pair(const std::function<Distance(float side)>& make, float blend);
    /// Roughness of the whole surface, added to the distance; smaller than `reach` everywhere.
    void set_roughness(Distance roughness, float reach);

    /// Naive surface nets [Gibson, Constrained Elastic Surface Nets, MICCAI 1998] on a grid of cells of the
    /// given size. The surface must lie within the box.
    [[nodiscard]] Mesh mesh(const Aabb& box, float cell) const;

  private:
    struct Part {
        Distance distance;
        float blend;
        bool cuts;
    };
    friend class CarvingMesher;

    [[nodiscard]] float distance(Vec3 p, const std::vector<const Part*>& parts) const;

    std::vector<Part> parts_;
    Distance roughness_;
    float roughness_reach_ = 0.0f;
};

}  // namespace nearlight::core::scenes
