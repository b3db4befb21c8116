// SPDX-License-Identifier: Apache-2.0
// Top-down construction of the tree; flatten.h turns it into its final layout.
#pragma once

#include <span>

#include "host/bvh/bvh.h"
#include "host/bvh/unset_vector.h"

namespace nearlight::core {

/// A tree before flattening. An inner node whose right child begins at position p of `order` is in slot p −
/// 1. No two nodes divide at the same position, so threads need not agree on slots, and the tree is the same
/// for any number of threads. Some slots are unused, and so are positions in `order` that were kept free for
/// cut triangles.
struct SahTree {
    UnsetVector<BvhNode> slots;
    UnsetVector<uint> order;  ///< indices into Scene::triangles, to which the leaves refer
    uint root = 0;            ///< child reference: a slot, or the leaf if there is only one
    Aabb root_box;
    std::size_t inner_count = 0;
    int depth = 0;  ///< upper bound of the depth of the deepest leaf; 0 if the root is a leaf
};

/// Builds a tree over the triangles `ids`, which must not be empty. Throws Error(ErrorKind::out_of_memory) if
/// there are more than leaf references can address.
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
