// SPDX-License-Identifier: Apache-2.0
// Which nodes of a binary tree become nodes, children and leaves of a wide one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// A child of a wide node: a reference of the binary tree, and its box.
struct WideChild {
    uint reference = 0;
    Aabb box;
};

/// All children of a wide node.
struct WideChildren {
    std::array<WideChild, NEARLIGHT_WIDE_CHILDREN> children;
    std::size_t count = 0;
};

/// Decides how a binary tree becomes a wide one. A subtree with no more triangles than a block becomes a
/// leaf. Above the leaves, dynamic programming finds the collapse whose nodes have the minimum total surface
/// [Ylitie et al., Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017].
class CollapsePlan {
  public:
    /// Makes the plan in parallel, with 52 bytes a binary node. `bvh` must outlive the plan.
    explicit CollapsePlan(const Bvh& bvh);

    /// Whether the reference becomes a leaf of the wide tree, with all triangles below it.
    [[nodiscard]] bool becomes_leaf(uint reference) const;
    /// The number of triangles below a reference.
    [[nodiscard]] uint triangle_count(uint reference) const;
    /// The children of the wide node that a binary node becomes, in order of increasing surface.
    [[nodiscard]] WideChildren children(uint node) const;
    [[nodiscard]] const Bvh& bvh() const { return *bvh_; }

  private:
    static constexpr std::size_t kMax = NEARLIGHT_WIDE_CHILDREN;

    struct Plan {
        /// Element i: total surface of the wide nodes from here down, if up to i children stand for this
        /// node.
        std::array<float, kMax + 1> cost{};
        /// Element i: how many of i children are on the left side; 0 if a single one stands for the node.
        std::array<std::uint8_t, kMax + 1> left{};
        std::uint8_t left_of_all = 0;  ///< how many of the node's own children are on the left side
        bool is_leaf = false;
        uint triangles = 0;
    };

    void plan(uint node, float half_area, int level);
    void divide(Plan& plan, const BvhNode& node, float half_area) const;
    [[nodiscard]] float cost(const WideChild& child, std::size_t max_children) const;
    void take(const WideChild& child, std::size_t max_children, WideChildren& children) const;

    const Bvh* bvh_;
    std::vector<Plan> plans_;  ///< one for each binary node
};

}  // namespace nearlight::core
