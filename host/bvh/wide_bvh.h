// SPDX-License-Identifier: Apache-2.0
// The tree for CPUs: eight children a node, triangles in blocks of four.
#pragma once

#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

struct WideBvh {
    std::vector<WideNode> nodes;  ///< at least one; node 0 is the root
    std::vector<TriangleBlock> blocks;
    /// Index in Scene::triangles of each column of each block, 4 · block + column; ~0u where there is none.
    std::vector<uint> triangle_ids;
};

/// Collapses a binary tree at the least cost (collapse_plan.h). Children stand by growing surface, so that a
/// stack yields the largest first, which is likeliest to occlude. Boxes and triangles are those of `bvh`, bit
/// by bit. In parallel, with the same result for any number of threads. Needs 200 bytes a triangle.
WideBvh widen(const Bvh& bvh);

/// Fills in the blocks that triangle_ids names.
void fetch_blocks(WideBvh& wide, const Scene& scene);

/// Checks that the wide tree holds the same triangles as `bvh`, each in boxes that hold it, and that
/// references are in range and reached once. Returns what is wrong, one line each; empty if sound.
std::vector<std::string> check_wide_bvh(const WideBvh& wide, const Bvh& bvh);

}  // namespace nearlight::core
