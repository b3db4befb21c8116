// SPDX-License-Identifier: Apache-2.0
// Top-down construction of the tree; flatten.h turns it into its final layout.
#pragma once

#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/bvh/unset_vector.h"

namespace nearlight::core {

/// A tree before flattening. The inner node whose right child has its room from position p of `order` on
/// stands in slot p − 1: no two nodes part at the same place, so that threads need not agree on who gets
/// which slot, and the tree is the same for any number of them. Slots of no node are left unused, and so are
/// places in `order` that were kept free for cut triangles.
struct SahTree {
    UnsetVector<BvhNode> slots;
    UnsetVector<uint> order;  ///< indices into Scene::triangles, where the leaves refer to
    uint root = 0;            ///< child reference: a slot, or the only leaf
    Aabb root_box;
    std::size_t inner_count = 0;
    int depth = 0;  ///< of the deepest leaf or more, 0 where the root is one
};

/// `ids` must not be empty, nor longer than a leaf reference can address: Error(out_of_memory).
SahTree build_sah_tree(const Scene& scene, std::span<const uint> ids, const BvhConfig& config);

/// Child reference of a leaf of 1 to 16 triangles.
constexpr uint leaf_reference(uint first, uint count) {
    return NEARLIGHT_LEAF_BIT | ((count - 1u) << NEARLIGHT_LEAF_COUNT_SHIFT) | first;
}
constexpr bool is_leaf(uint reference) {
    return (reference & NEARLIGHT_LEAF_BIT) != 0;
}
constexpr uint leaf_first(uint reference) {
    return reference & NEARLIGHT_LEAF_FIRST_MASK;
}
constexpr uint leaf_count(uint reference) {
    return ((reference >> NEARLIGHT_LEAF_COUNT_SHIFT) & NEARLIGHT_LEAF_COUNT_MASK) + 1u;
}

}  // namespace nearlight::core
