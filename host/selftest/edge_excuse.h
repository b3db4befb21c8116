// SPDX-License-Identifier: Apache-2.0
// Which disagreements over a shadow ray single precision explains.
#pragma once

#include <span>

#include "host/bvh/segment_distance.h"

namespace nearlight::core {

/// Excuses segments that pass an edge within 10⁻⁵ of the scene's extent, but only so many: where everything
/// is wrong, looking closely at each segment would take minutes and excuse nothing.
class EdgeExcuse {
  public:
    EdgeExcuse(std::span<const BvhTriangle> triangles, float extent)
        : triangles_(triangles), tolerance_(1e-5 * extent) {}

    bool excuses(Vec3 from, Vec3 to) {
        return looks_left_ > 0 && (--looks_left_, distance_to_edges(triangles_, from, to) <= tolerance_);
    }

  private:
    std::span<const BvhTriangle> triangles_;
    double tolerance_;
    int looks_left_ = 400;
};

}  // namespace nearlight::core
