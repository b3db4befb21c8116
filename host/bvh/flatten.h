// SPDX-License-Identifier: Apache-2.0
// Turns a tree as it was built into its final layout.
#pragma once

#include "host/bvh/bvh.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {

/// Moves the nodes of a tree into depth-first order, so that a left child that is an inner node follows its
/// parent, fetches the triangles, and fills in depth and cost. Frees the memory of `tree`.
Bvh flatten(SahTree&& tree, const Scene& scene, const BvhConfig& config);

/// A triangle of the scene as trees hold it; a degenerate one far away for the id ~0u.
BvhTriangle fetch_triangle(const Scene& scene, uint id);

/// Fills in Bvh::triangles, which Bvh::triangle_ids names.
void fetch_triangles(Bvh& bvh, const Scene& scene);

/// A tree without triangles: one leaf that holds a single degenerate triangle far away. Its id is ~0u.
Bvh empty_bvh();

/// Expected cost of a ray that meets the root's box [MacDonald and Booth, Heuristics for Ray Tracing Using
/// Space Subdivision, 1990]: each node and triangle counts with the probability that its box is met.
double sah_cost(const Bvh& bvh, const BvhConfig& config);

}  // namespace nearlight::core
