// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_placement.h"

#include <algorithm>
#include <cmath>

#include "host/stages/joint_programs.h"
#include "host/stages/runs.h"

namespace nearlight::core {

float area_units_per_square_metre(double total_area) {
    // total_area · 2^exponent lies in [2^61, 2^62); the two bits above have room for what rounding adds.
    const int exponent = total_area > 0.0 ? 61 - std::ilogb(total_area) : 0;
    return static_cast<float>(std::ldexp(1.0, std::clamp(exponent, -100, 100)));
}

VplPlacement::VplPlacement(Device& device)
    : device_(&device),
      program_(device, "vpl_placement.cl", kVplsProgram),
      areas_(program_, "placement_areas"),
      place_(program_, "place_samples"),
      scan_(device) {}

void VplPlacement::set_surface(const Buffer<float>& areas, const Buffer<uint>& ids, std::size_t count,
                               float units_per_square_metre) {
    triangle_count_ = count;
    ensure_room(area_sums_, *device_, count);
    areas_.launch_items(count, areas, ids, area_sums_, units_per_square_metre,
                        to_kernel_count(count, "triangles"));
    scan_.inclusive(area_sums_, area_sums_, count);
    total_area_ = static_cast<double>(scan_.total().download_one(0)) / units_per_square_metre;
}

std::size_t VplPlacement::place(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                                const Buffer<uint>& ids, const Buffer<CloseRange>& range,
                                bool whole_triangles, std::size_t sample_count, uint seed,
                                Buffer<SurfaceSample>& samples) {
    if (sample_count == 0 || !(total_area_ > 0.0)) {
        return 0;
    }
    place_.launch_items(sample_count, vertices, triangles, ids, area_sums_, range, whole_triangles ? 1u : 0u,
                        samples, static_cast<uint>(triangle_count_), to_kernel_count(sample_count, "samples"),
                        seed);
    return sample_count;
}

}  // namespace nearlight::core
