// SPDX-License-Identifier: Apache-2.0
// The surface in the close range, and points spread evenly over it [paper §3, steps 1 to 5].
#pragma once

#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// Which triangles are selected, and which part of them belongs to the close region.
struct CloseSelection {
    bool only_lit = true;          ///< leave out triangles that light does not reach
    bool whole_triangles = false;  ///< selected triangles belong to the region as a whole, not point by point
};

class CloseSurface {
  public:
    /// Classifies the triangles and puts them in Morton order. Keeps references to `stages` and `task`.
    CloseSurface(SamplerStages& stages, const SamplingTask& task, const CloseSelection& selection);

    [[nodiscard]] const CloseRegion& region() const { return region_; }
    /// The area on which points are placed, m².
    [[nodiscard]] double area() const { return surface_.area; }
    /// Whether no triangle was selected, or the selected triangles have no area.
    [[nodiscard]] bool empty() const { return surface_.empty(); }

    /// Places `point_count` points, one in each of as many equal parts of the surface, and returns VPLs
    /// without light: their power is the albedo times the area (m²) that a point stands for. Each side of a
    /// point gives a VPL if it reflects and the point is in the region. VPLs are in order along the Morton
    /// curve.
    [[nodiscard]] std::vector<Vpl> place(std::size_t point_count, uint seed);

  private:
    SamplerStages& stages_;
    const SamplingTask& task_;
    CloseRegion region_;
    PlacementSurface surface_;  ///< the selected triangles along the Morton curve
};

}  // namespace nearlight::core
