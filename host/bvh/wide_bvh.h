// SPDX-License-Identifier: Apache-2.0
// The wide tree, for CPUs: eight children a node, triangles in blocks of four.
#pragma once

#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

struct WideBvh {
    std::vector<WideNode> nodes;  ///< at least one; node 0 is the root
    std::vector<TriangleBlock> blocks;
    /// Element 4 · block + column is the index of that column's triangle in Scene::triangles; ~0u if there is
    /// none.
    std::vector<uint> triangle_ids;
};

/// Collapses a binary tree at the minimum cost (collapse_plan.h). Children are in order of increasing
/// surface, so that a stack yields the largest first, which is the likeliest to occlude. Boxes and triangles
/// are those of `bvh`, bit by bit. The work is parallel, with the same result for any number of threads, and
/// takes 200 bytes a triangle.
WideBvh widen(const Bvh& bvh);

/// Fills in WideBvh::blocks, whose triangles WideBvh::triangle_ids names.
void fetch_blocks(WideBvh& wide, const Scene& scene);

/// Checks that the wide tree holds the same triangles as `bvh`, each in boxes that hold it, and that
/// references are in range and reached once. Returns one line for each fault; empty if the tree is sound.
std::vector<std::string> check_wide_bvh(const WideBvh& wide, const Bvh& bvh);

}  // namespace nearlight::core
