// SPDX-License-Identifier: Apache-2.0
// What a tree costs to trace, counted: the same on any machine, however busy.
#pragma once

#include <cstdint>
#include <span>

#include "host/bvh/bvh.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Work of any-hit rays from VPLs to receivers whose cosines are both positive. A node is one visit, with
/// tests of both child boxes.
struct TreeSteps {
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    double nodes_per_ray = 0.0;  ///< a ray alone, nearer child first, as the kernels for one ray go
    double triangles_per_ray = 0.0;
    std::uint64_t packets = 0;      ///< of the rays of one VPL and up to 64 receivers
    double nodes_per_packet = 0.0;  ///< together, children in stored order, as the packet kernel goes
    double triangles_per_packet = 0.0;
};

TreeSteps count_steps(const Bvh& bvh, std::span<const Vpl> vpls, std::span<const ReceiverPacket> receivers,
                      int threads);

}  // namespace nearlight::core
