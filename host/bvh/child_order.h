// SPDX-License-Identifier: Apache-2.0
// The order of the two children of a node. Shadow rays end at the first hit, and the packet kernel goes down
// the tree in stored order, so the child that is likely to end a ray soon should come first.
#pragma once

#include <span>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// Puts the child with the higher chance of a hit ÷ expected cost first, which minimises the expected cost of
/// any-hit rays [Ize and Hansen, RTSAH Traversal Order for Occlusion Rays, 2011]. Chances and costs are
/// counted with segments between random points of the triangles `ids`; where few of them pass, areas stand
/// in, as in the paper. The nodes of `bvh` are in depth-first order before and afterwards. The result depends
/// on the arguments only.
void order_children(Bvh& bvh, const Scene& scene, std::span<const uint> ids);

}  // namespace nearlight::core
