// SPDX-License-Identifier: Apache-2.0
// Small gathers of all kinds, and the term that a pair of them contributes.
#pragma once

#include <string>
#include <vector>

#include "host/base/receivers.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core::test {

struct GatherCase {
    std::string name;
    Scene scene;
    Bvh bvh;
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
    float clamp_radius = 0.1f;
    float extent = 2.0f;  ///< everything is in [−extent/2, extent/2]³
};

/// Triangles, VPLs and receivers at random places with random directions.
GatherCase random_triangles(std::size_t triangles, std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// VPLs and receivers a small distance off the walls of a room and off the boxes in it.
GatherCase room_of_boxes(std::size_t boxes, std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// Triangles whose corners lie on a coarse grid; VPLs and receivers are on grid points, with little variety
/// within packets.
GatherCase points_on_grid(std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// Very thin triangles, and some that are lines or points.
GatherCase needles(std::size_t triangles, std::size_t vpls, std::size_t packets, std::uint64_t seed);

/// VPLs `distance` above receivers, and a sheet `gap` above these that hides each from each.
GatherCase sheet_above_receivers(float gap, float distance, std::size_t vpls, std::size_t packets);

struct PairTerm {
    double value = 0.0;  ///< max0(cosθx)·max0(cosθy)/max(r², R²), 0 where not finite or seen from behind
    double min_cosine = 0.0;  ///< the least magnitude of the cosines, that to the shading normal included
};
PairTerm pair_term(const Vpl& vpl, const ReceiverPoint& receiver, float clamp_radius);

}  // namespace nearlight::core::test
