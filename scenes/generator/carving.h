// SPDX-License-Identifier: Apache-2.0
// Sculptures from signed distances: solids are blended into one another, and the surface becomes triangles.
#pragma once

#include <functional>
#include <vector>

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// Distance to a surface in metres, negative inside. It may be wrong by a third, but not in its sign.
using Distance = std::function<float(Vec3)>;

Distance solid_ellipsoid(Vec3 center, Vec3 radii);
/// Two balls about a and b and the cone that touches both.
Distance solid_cone(Vec3 a, Vec3 b, float radius_a, float radius_b);
/// A ball with a spiral groove about the axis through its centre. The groove makes `turns` turns from the
/// pole to the equator.
Distance solid_curl(Vec3 center, Vec3 axis, float radius, float turns);
Distance solid_box(Vec3 center, Vec3 half, float rounding);

class Carving {
  public:
    /// Adds a part, blended over about `blend` metres.
    void add(Distance part, float blend);
    /// Cuts a part out, blended over about `blend` metres.
    void cut(Distance part, float blend);
    /// Adds a part on each side of the plane x = 0: calls `make` with 1 for x > 0, then with −1.
    void add_pair(const std::function<Distance(float side)>& make, float blend);
    /// Sets the roughness of the whole surface, which is added to the distance. It must be smaller than
    /// `reach` everywhere.
    void set_roughness(Distance roughness, float reach);

    /// The surface as triangles, by naive surface nets [Gibson, Constrained Elastic Surface Nets, MICCAI
    /// 1998] on a grid with cells of `cell` metres. The surface must lie within the box.
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
