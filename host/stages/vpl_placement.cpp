// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_placement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/stages/joint_programs.h"
#include "host/stages/runs.h"
#include "nearlight/error.h"

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

PlacementSurface VplPlacement::surface_of(const Buffer<float>& areas, Buffer<uint> ids, std::size_t count,
                                          float units_per_square_metre) {
    PlacementSurface surface{
        .ids = std::move(ids), .area_sums = Buffer<std::uint64_t>(*device_, count), .triangle_count = count};
    areas_.launch_items(count, areas, surface.ids, surface.area_sums, units_per_square_metre,
                        to_kernel_count(count, "triangles"));
    scan_.inclusive(surface.area_sums, surface.area_sums, count);
    surface.area = static_cast<double>(scan_.total().download_one(0)) / units_per_square_metre;
    return surface;
}

void VplPlacement::place(const PlacementSurface& surface, const Buffer<Vertex>& vertices,
                         const Buffer<Triangle>& triangles, const Buffer<CloseRange>& range,
                         bool whole_triangles, std::size_t sample_count, uint seed,
                         Buffer<SurfaceSample>& samples) {
    if (surface.empty()) {
        throw Error(ErrorKind::invalid_argument, "there is no surface to place points on");
    }
    place_.launch_items(sample_count, vertices, triangles, surface.ids, surface.area_sums, range,
                        whole_triangles ? 1u : 0u, samples, static_cast<uint>(surface.triangle_count),
                        to_kernel_count(sample_count, "samples"), seed);
}

}  // namespace nearlight::core
