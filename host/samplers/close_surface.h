// SPDX-License-Identifier: Apache-2.0
// The surface near and before the camera, and points spread evenly over it [paper §3, steps 1 to 5].
#pragma once

#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// Which triangles are selected, and what belongs to the region.
struct CloseSelection {
    bool only_lit = true;          ///< leave out triangles that light does not reach
    bool whole_triangles = false;  ///< a selected triangle belongs to the region whole, not point by point
};

class CloseSurface {
  public:
    /// Classifies the triangles and puts them in Morton order.
    CloseSurface(SamplerStages& stages, const SamplingTask& task, const CloseSelection& selection);

    [[nodiscard]] const CloseRegion& region() const { return region_; }
    [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }
    [[nodiscard]] double area() const { return area_; }  ///< of the selected triangles, m²
    /// No triangle was selected, or those that were have no area.
    [[nodiscard]] bool empty() const { return triangle_count_ == 0 || !(area_ > 0.0); }

    /// `point_count` points, each in one of as many equal parts of the surface, as VPLs on both sides,
    /// without light: power is albedo times the area a point stands for. Only those on sides that reflect and
    /// in the region, along the Morton curve.
    [[nodiscard]] std::vector<Vpl> place(std::size_t point_count, uint seed);

  private:
    SamplerStages& stages_;
    const SamplingTask& task_;
    CloseRegion region_;
    Buffer<uint> ids_;  ///< of the selected triangles, along the Morton curve
    std::size_t triangle_count_ = 0;
    double area_ = 0.0;  ///< m²
};

}  // namespace nearlight::core
