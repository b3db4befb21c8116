// SPDX-License-Identifier: Apache-2.0
// Counts the steps of rays through a tree. The counts are the same on every machine.
#pragma once

#include <cstdint>
#include <span>

#include "host/bvh/bvh.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Counts for any-hit rays from VPLs to receivers whose cosines are both positive. A node is one visit, with
/// tests of both child boxes.
struct TreeSteps {
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    /// Each ray by itself, nearer child first, as in the kernels for single rays.
    double nodes_per_ray = 0.0;
    double triangles_per_ray = 0.0;
    std::uint64_t packets = 0;      ///< each has the rays between one VPL and up to 64 receivers
    double nodes_per_packet = 0.0;  ///< rays together, children in stored order, as in the packet kernel
    double triangles_per_packet = 0.0;
};

/// Counts the steps of all pairs. @param threads at least 1
TreeSteps count_steps(const Bvh& bvh, std::span<const Vpl> vpls, std::span<const ReceiverPacket> receivers,
                      int threads);

}  // namespace nearlight::core
