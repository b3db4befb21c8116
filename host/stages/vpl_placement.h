// SPDX-License-Identifier: Apache-2.0
// Points spread evenly over the area of selected triangles. Kernels: vpl_placement.cl.
#pragma once

#include <cstdint>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/prefix_scan.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Units of area per m² for fixed-point sums: the power of two at which triangles of `total_area` in all (>
/// 0, of the whole scene, so that any selection fits) sum up to less than 2^62. A triangle's area is then
/// rounded by at most total_area · 2^-62.
float area_units_per_square_metre(double total_area);

class VplPlacement {
  public:
    explicit VplPlacement(Device& device);

    /// Takes the triangles to place on: `ids` (the first `count`, in Morton order), which index `areas` (m²),
    /// and a scale from area_units_per_square_metre(). Keeps a copy of neither; waits for the device.
    void set_surface(const Buffer<float>& areas, const Buffer<uint>& ids, std::size_t count,
                     float units_per_square_metre);
    /// Area of that surface, m²: a point of K stands for total_area() / K of it.
    [[nodiscard]] double total_area() const { return total_area_; }

    /// Places `sample_count` points, one in each of as many equal parts of the surface, on the surface
    /// itself. `ids` as in set_surface(). Returns how many: sample_count, or 0 if the surface has no area.
    std::size_t place(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                      const Buffer<uint>& ids, std::size_t sample_count, uint seed,
                      Buffer<SurfaceSample>& samples);

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
