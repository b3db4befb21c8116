// SPDX-License-Identifier: Apache-2.0
// Which of two children comes first. Shadow rays end at the first hit, and the packet kernel goes down the
// tree in stored order: the child that is likely to end a ray soon should come first.
#pragma once

#include <span>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// `bvh` is in depth-first order. Puts the child with the higher chance of a hit ÷ expected cost first, which
/// minimises the expected cost of any-hit rays [Ize and Hansen, RTSAH Traversal Order for Occlusion Rays,
/// 2011]. Chances and costs are counted with segments between random points of the surfaces `ids`; where few
/// of them pass, areas stand in, as in the paper. Nodes are put into depth-first order again. The same for
/// the same arguments.
void order_children(Bvh& bvh, const Scene& scene, std::span<const uint> ids);

}  // namespace nearlight::core
