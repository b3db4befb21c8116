// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/wide_bvh.h"

#include <algorithm>
#include <limits>

#include "host/bvh/collapse_plan.h"
#include "host/bvh/sah_builder.h"

namespace nearlight {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void put(float (&rows)[3][NEARLIGHT_BLOCK_TRIANGLES], std::size_t column, Vec3 v) {
    rows[0][column] = v.x;
    rows[1][column] = v.y;
    rows[2][column] = v.z;
}

class Widener {
  public:
    explicit Widener(const Bvh& bvh) : bvh_(bvh), plan_(bvh) {}

    WideBvh widen() && {
        wide_.nodes.reserve(bvh_.triangles.size() / 8 + 1);
        wide_.blocks.reserve(bvh_.triangles.size() / 3 + 1);
        add_node(0);
        return std::move(wide_);
    }

  private:
    uint add_node(uint node_index) {
        std::vector<WideChild> children = plan_.children(node_index);
        std::stable_sort(children.begin(), children.end(), [](const WideChild& a, const WideChild& b) {
            return a.box.half_area() < b.box.half_area();
        });
        const std::size_t index = wide_.nodes.size();
        wide_.nodes.emplace_back();
        WideNode node{};
        std::fill_n(&node.low[0][0], 3 * NEARLIGHT_WIDE_CHILDREN, kInfinity);
        std::fill_n(&node.high[0][0], 3 * NEARLIGHT_WIDE_CHILDREN, -kInfinity);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const Aabb& box = children[i].box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                node.low[axis][i] = (&box.min.x)[axis];
                node.high[axis][i] = (&box.max.x)[axis];
            }
            const uint reference = children[i].reference;
            node.child[i] = plan_.becomes_leaf(reference) ? add_leaf(reference) : add_node(reference);
        }
        wide_.nodes[index] = node;
        return static_cast<uint>(index);
    }

    void append_triangles(uint reference, std::vector<uint>& triangles) const {
        if (!is_leaf(reference)) {
            append_triangles(bvh_.nodes[reference].left, triangles);
            append_triangles(bvh_.nodes[reference].right, triangles);
            return;
        }
        for (uint i = 0; i < leaf_count(reference); ++i) {
            triangles.push_back(leaf_first(reference) + i);
        }
    }

    uint add_leaf(uint reference) {
        std::vector<uint> triangles;
        append_triangles(reference, triangles);
        const std::size_t first = wide_.blocks.size();
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const std::size_t column = i % NEARLIGHT_BLOCK_TRIANGLES;
            if (column == 0) {
                wide_.blocks.emplace_back();
            }
            TriangleBlock& block = wide_.blocks.back();
            const BvhTriangle& triangle = bvh_.triangles[triangles[i]];
            put(block.v0, column, triangle.v0);
            put(block.edge1, column, triangle.edge1);
            put(block.edge2, column, triangle.edge2);
        }
        return leaf_reference(static_cast<uint>(first), static_cast<uint>(wide_.blocks.size() - first));
    }

    const Bvh& bvh_;
    CollapsePlan plan_;
    WideBvh wide_;
};

}  // namespace

WideBvh widen(const Bvh& bvh) {
    return Widener(bvh).widen();
}

}  // namespace nearlight
