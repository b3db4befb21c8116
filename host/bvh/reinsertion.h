// SPDX-License-Identifier: Apache-2.0
// Repairs what building from the top down spoils near the root.
#pragma once

#include "host/bvh/sah_builder.h"

namespace nearlight::core {

/// Takes each of the largest boxes out of the tree, whereupon those around it shrink, and puts it where it
/// adds the least surface [Bittner, Hapala and Havran, Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies, 2013]. Parting everything by one plane after another leaves a wall together with whatever
/// stands before it; here it rises to the top. Only inner nodes trade places, leaves stay as they are. By one
/// thread, a few thousand nodes in some milliseconds; does nothing where the tree could get too deep, or
/// where surfaces leave the range of floats. `tree.depth` becomes an upper bound.
void reinsert_largest(SahTree& tree);

}  // namespace nearlight::core
