// SPDX-License-Identifier: Apache-2.0
// Places points evenly over the area of selected triangles. The kernels are in vpl_placement.cl.
#pragma once

#include <cstdint>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/prefix_scan.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// The number of units of area per m² in fixed-point sums: the power of two for which triangles with a total
/// of `total_area` m² sum up to less than 2^62. `total_area` is above 0 and that of the whole scene, so that
/// any selection fits. The area of a triangle is then rounded by at most total_area · 2^-62.
float area_units_per_square_metre(double total_area);

class VplPlacement {
  public:
    explicit VplPlacement(Device& device);

    /// Sets the triangles to place points on: the first `count` elements of `ids`, in Morton order, which
    /// index `areas` (m²). The scale comes from area_units_per_square_metre(). Does not keep `ids` or
    /// `areas`; waits for the device.
    void set_surface(const Buffer<float>& areas, const Buffer<uint>& ids, std::size_t count,
                     float units_per_square_metre);
    /// The area in m² of the triangles that set_surface() took. Each of K points stands for total_area() / K
    /// of it.
    [[nodiscard]] double total_area() const { return total_area_; }

    /// Places `sample_count` points on the surface, one in each of as many equal parts of its area. `ids`
    /// must be those of set_surface(), and `range` (one element) and `whole_triangles` must be those that
    /// TriangleClassifier::classify() found the areas with. Returns the number of points: sample_count, or 0
    /// if the surface has no area.
    std::size_t place(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                      const Buffer<uint>& ids, const Buffer<CloseRange>& range, bool whole_triangles,
                      std::size_t sample_count, uint seed, Buffer<SurfaceSample>& samples);

  private:
    Device* device_;
    Program program_;
    Kernel areas_;
    Kernel place_;
    PrefixScan<std::uint64_t> scan_;
    Buffer<std::uint64_t> area_sums_;
    std::size_t triangle_count_ = 0;
    double total_area_ = 0.0;
};

}  // namespace nearlight::core
