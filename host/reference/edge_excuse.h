// SPDX-License-Identifier: Apache-2.0
// Decides which disagreements about a shadow ray single precision explains.
#pragma once

#include <span>

#include "host/bvh/segment_distance.h"

namespace nearlight::core {

/// Maximum distance from an edge at which both answers about a segment are right, as a fraction of the
/// scene's extent.
inline constexpr double kSegmentEdgeTolerance = 1e-5;

/// Excuses segments that pass an edge within kSegmentEdgeTolerance. It examines a limited number of them:
/// where everything is wrong, examining each segment would take minutes and excuse nothing.
class EdgeExcuse {
  public:
    EdgeExcuse(std::span<const BvhTriangle> triangles, float extent)
        : triangles_(triangles), tolerance_(kSegmentEdgeTolerance * extent) {}

    bool excuses(Vec3 from, Vec3 to) {
        return looks_left_ > 0 && (--looks_left_, distance_to_edges(triangles_, from, to) <= tolerance_);
    }

  private:
    std::span<const BvhTriangle> triangles_;
    double tolerance_;
    int looks_left_ = 400;
};

}  // namespace nearlight::core
