// SPDX-License-Identifier: Apache-2.0
// Repairs the damage that building from the top down does near the root.
#pragma once

#include "host/bvh/sah_builder.h"

namespace nearlight::core {

/// Takes each of the largest boxes out of the tree, so that the boxes around it shrink, and puts it where it
/// adds the minimum surface [Bittner, Hapala and Havran, Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies, 2013]. Splitting by one plane after another leaves a wall together with whatever stands in
/// front of it; reinsertion moves the wall to the top. Only inner nodes change places; leaves stay as they
/// are. One thread moves a few thousand nodes in some milliseconds. Nothing happens if the tree could become
/// too deep, or if surfaces leave the range of floats. `tree.depth` becomes an upper bound.
void reinsert_largest(SahTree& tree);

}  // namespace nearlight::core
