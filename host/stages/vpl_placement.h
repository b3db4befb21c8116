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

/// Triangles to place points on.
struct PlacementSurface {
    Buffer<uint> ids;                 ///< of the triangles, in Morton order
    Buffer<std::uint64_t> area_sums;  ///< for each of them, the area up to and with it, in fixed point
    std::size_t triangle_count = 0;
    double area = 0.0;  ///< of all of them, m²; each of K points stands for area / K

    /// Whether there is nothing to place points on.
    [[nodiscard]] bool empty() const { return !(area > 0.0); }
};

class VplPlacement {
  public:
    explicit VplPlacement(Device& device);

    /// The surface of the first `count` elements of `ids`, in Morton order, which index `areas` (m²). The
    /// scale comes from area_units_per_square_metre(). Waits for the device.
    PlacementSurface surface_of(const Buffer<float>& areas, Buffer<uint> ids, std::size_t count,
                                float units_per_square_metre);

    /// Places `sample_count` points on a surface that is not empty, one in each of as many equal parts of its
    /// area. `range` (one element) and `whole_triangles` must be those that TriangleClassifier::classify()
    /// found the areas with.
    void place(const PlacementSurface& surface, const Buffer<Vertex>& vertices,
               const Buffer<Triangle>& triangles, const Buffer<CloseRange>& range, bool whole_triangles,
               std::size_t sample_count, uint seed, Buffer<SurfaceSample>& samples);

  private:
    Device* device_;
    Program program_;
    Kernel areas_;
    Kernel place_;
    PrefixScan<std::uint64_t> scan_;
};

}  // namespace nearlight::core
