// SPDX-License-Identifier: Apache-2.0
// Which nodes of a binary tree become nodes, children and leaves of a wide one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/bvh/bvh.h"

namespace nearlight::core {

/// A child of a node of the wide tree: a reference of the binary one, and its box.
struct WideChild {
    uint reference = 0;
    Aabb box;
};

/// All of a node's.
struct WideChildren {
    std::array<WideChild, NEARLIGHT_WIDE_CHILDREN> children;
    std::size_t count = 0;
};

/// What holds no more than a block of triangles is a leaf; of what is above, the collapse whose nodes have
/// the least surface in all, by dynamic programming [Ylitie et al., Efficient Incoherent Ray Traversal on
/// GPUs Through Compressed Wide BVHs, 2017].
class CollapsePlan {
  public:
    /// In parallel. Needs 60 bytes a binary node. `bvh` must outlive it.
    explicit CollapsePlan(const Bvh& bvh);

    /// Whether what the reference names is a leaf of the wide tree, with all triangles below it.
    [[nodiscard]] bool becomes_leaf(uint reference) const;
    /// Triangles below a reference.
    [[nodiscard]] uint triangle_count(uint reference) const;
    /// The children of the wide node that a binary node becomes, by growing surface.
    [[nodiscard]] WideChildren children(uint node) const;
    [[nodiscard]] const Bvh& bvh() const { return *bvh_; }

  private:
    static constexpr std::size_t kMax = NEARLIGHT_WIDE_CHILDREN;

    struct Plan {
        /// Surface of all wide nodes from here on, if up to i children stand for this binary node.
        std::array<float, kMax + 1> cost{};
        /// Of i children, how many are on the left side; 0: a single one stands for the node.
        std::array<std::uint8_t, kMax + 1> left{};
        std::uint8_t left_of_all = 0;  ///< the same for all children of the node itself
        bool is_leaf = false;
        uint triangles = 0;
    };

    void plan(uint node, float half_area, int level);
    void divide(Plan& plan, const BvhNode& node, float half_area) const;
    [[nodiscard]] float cost(const WideChild& child, std::size_t most) const;
    void take(const WideChild& child, std::size_t most, WideChildren& children) const;

    const Bvh* bvh_;
    std::vector<Plan> plans_;  ///< of each binary node
};

}  // namespace nearlight::core
