// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "host/bvh/sah_builder.h"
#include "host/bvh/wide_bvh.h"

namespace nearlight::core {
namespace {

/// A triangle's id and its v0, edge1 and edge2, for sorting and comparing.
using TriangleCorners = std::pair<uint, std::array<float, 9>>;

TriangleCorners corners_of(uint id, const BvhTriangle& triangle) {
    return {id,
            {triangle.v0.x, triangle.v0.y, triangle.v0.z, triangle.edge1.x, triangle.edge1.y,
             triangle.edge1.z, triangle.edge2.x, triangle.edge2.y, triangle.edge2.z}};
}

Vec3 column_of(const float (&rows)[3][NEARLIGHT_BLOCK_TRIANGLES], std::size_t column) {
    return {rows[0][column], rows[1][column], rows[2][column]};
}

/// Traverses the tree and collects complaints.
class WideChecker {
  public:
    WideChecker(const WideBvh& wide, const Bvh& bvh) : wide_(wide), bvh_(bvh) {}

    std::vector<std::string> check() {
        node_visits_.assign(wide_.nodes.size(), 0);
        block_visits_.assign(wide_.blocks.size(), 0);
        if (wide_.nodes.empty()) {
            return {"there is no node"};
        }
        if (wide_.triangle_ids.size() != NEARLIGHT_BLOCK_TRIANGLES * wide_.blocks.size()) {
            return {"there are not as many triangle ids as columns of blocks"};
        }
        for (std::size_t i = 0; i < bvh_.triangles.size(); ++i) {
            wanted_.push_back(corners_of(bvh_.triangle_ids[i], bvh_.triangles[i]));
        }
        std::sort(wanted_.begin(), wanted_.end());
        visit_node(0);
        check_visits();
        std::sort(found_.begin(), found_.end());
        if (wanted_ != found_) {
            complain("the wide tree holds other triangles than the binary one");
        }
        return std::move(complaints_);
    }

  private:
    void complain(const std::string& text) { complaints_.push_back(text); }

    /// Returns the box of all vertices below the node.
    Aabb visit_node(uint index) {
        ++node_visits_[index];
        const WideNode& node = wide_.nodes[index];
        Aabb box;
        for (std::size_t slot = 0; slot < NEARLIGHT_WIDE_CHILDREN; ++slot) {
            const std::string name = "node " + std::to_string(index) + " child " + std::to_string(slot);
            const Vec3 low{node.low[0][slot], node.low[1][slot], node.low[2][slot]};
            const Vec3 high{node.high[0][slot], node.high[1][slot], node.high[2][slot]};
            if (low.x > high.x && low.y > high.y && low.z > high.z) {
                continue;  // no child
            }
            const Aabb below = visit_child(node.child[slot], name);
            if (!below.is_empty() && !(min(low, below.min) == low && max(high, below.max) == high)) {
                complain(name + ": box does not hold what is below");
            }
            box.extend(below);
        }
        return box;
    }

    Aabb visit_child(uint reference, const std::string& name) {
        if (is_leaf(reference)) {
            return visit_leaf(reference, name);
        }
        if (reference >= wide_.nodes.size() || node_visits_[reference] > 0) {
            complain(name + ": refers to node " + std::to_string(reference) +
                     (reference >= wide_.nodes.size() ? ", out of range" : ", already in the tree"));
            return {};
        }
        return visit_node(reference);
    }

    Aabb visit_leaf(uint reference, const std::string& name) {
        Aabb box;
        const uint first = leaf_first(reference);
        if (first + leaf_count(reference) > wide_.blocks.size()) {
            complain(name + ": leaf out of range");
            return box;
        }
        for (uint i = first; i < first + leaf_count(reference); ++i) {
            ++block_visits_[i];
            const TriangleBlock& block = wide_.blocks[i];
            for (std::size_t column = 0; column < NEARLIGHT_BLOCK_TRIANGLES; ++column) {
                const Vec3 v0 = column_of(block.v0, column);
                const Vec3 edge1 = column_of(block.edge1, column);
                const Vec3 edge2 = column_of(block.edge2, column);
                const uint id = wide_.triangle_ids[NEARLIGHT_BLOCK_TRIANGLES * i + column];
                if (id == ~0u && is_zero(v0) && is_zero(edge1) && is_zero(edge2)) {
                    continue;  // no triangle
                }
                found_.push_back(corners_of(id, {v0, edge1, edge2, {}}));
                if (stands_once(found_.back())) {
                    // The sums may be rounded away from the vertices; the middle is well inside.
                    box.extend(v0 + (edge1 + edge2) * (1.0f / 3.0f));
                }
            }
        }
        return box;
    }

    /// Whether a triangle is in only one leaf. One in several leaves may be cut, and then a box holds only a
    /// part of it.
    [[nodiscard]] bool stands_once(const TriangleCorners& corners) const {
        const auto [first, last] = std::equal_range(wanted_.begin(), wanted_.end(), corners);
        return last - first == 1;
    }

    void check_visits() {
        const auto check = [this](const std::vector<int>& visits, const std::string& what) {
            for (std::size_t i = 0; i < visits.size(); ++i) {
                if (visits[i] != 1) {
                    complain(what + " " + std::to_string(i) + ": reached " + std::to_string(visits[i]) +
                             " times");
                }
            }
        };
        check(node_visits_, "node");
        check(block_visits_, "block");
    }

    const WideBvh& wide_;
    const Bvh& bvh_;
    std::vector<int> node_visits_;
    std::vector<int> block_visits_;
    std::vector<TriangleCorners> wanted_;  ///< sorted
    std::vector<TriangleCorners> found_;
    std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> check_wide_bvh(const WideBvh& wide, const Bvh& bvh) {
    return WideChecker(wide, bvh).check();
}

}  // namespace nearlight::core
