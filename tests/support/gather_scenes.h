// SPDX-License-Identifier: Apache-2.0
// Small gathers of all kinds, and what a pair of them contributes.
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
    float extent = 2.0f;  ///< all lies in [−extent/2, extent/2]³
};

/// Triangles, VPLs and receivers anywhere, facing anywhere.
GatherCase random_triangles(std::size_t triangles, std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// VPLs and receivers on the walls of a room and on the boxes in it, standing off a little.
GatherCase room_of_boxes(std::size_t boxes, std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// Triangles whose corners lie on a coarse grid; VPLs and receivers on grid points, in packets without
/// variety.
GatherCase points_on_grid(std::size_t vpls, std::size_t packets, std::uint64_t seed);
/// Very thin triangles, and some that are lines or points.
GatherCase needles(std::size_t triangles, std::size_t vpls, std::size_t packets, std::uint64_t seed);

struct PairTerm {
    double value = 0.0;       ///< max0(cosθx)·max0(cosθy)/max(r², R²), 0 where not finite
    double min_cosine = 0.0;  ///< the smaller magnitude of both cosines
};
PairTerm pair_term(const Vpl& vpl, const ReceiverPoint& receiver, float clamp_radius);

}  // namespace nearlight::core::test
