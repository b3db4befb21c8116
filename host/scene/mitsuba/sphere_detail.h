// SPDX-License-Identifier: Apache-2.0
// Into how many facets spheres are divided.
#pragma once

#include <vector>

#include "host/scene/mitsuba/object.h"
#include "host/scene/scene.h"

namespace nearlight::core::mitsuba {

/// How deep merges may lie in one another.
inline constexpr uint kMaxMergeDepth = 100;

/// Where the shape's unit sphere stands before `to_world`.
Mat4 sphere_placement(const Object& sphere);

/// Divides spheres as finely as shape_mesh.h can, as long as all of them have at most a few million triangles
/// together. Otherwise a sphere gets triangles in proportion to its radius, so that facets differ from the
/// true surface by about the same distance on all of them.
class SphereDetail {
  public:
    /// For a scene of these shapes, with those that instances and merges hold.
    explicit SphereDetail(const std::vector<const Object*>& shapes);

    /// Rows of facets from pole to pole: 6 to kFinestStacks.
    [[nodiscard]] uint stacks(const Object& sphere) const;
    /// Whether some sphere has fewer than kFinestStacks.
    [[nodiscard]] bool is_reduced() const { return is_reduced_; }

  private:
    double radii_ = 0.0;  ///< of all spheres together
    bool is_reduced_ = false;
};

}  // namespace nearlight::core::mitsuba
