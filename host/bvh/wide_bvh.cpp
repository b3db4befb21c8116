// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/wide_bvh.h"

#include <algorithm>
#include <span>

#include "host/base/math.h"
#include "host/bvh/collapse_plan.h"
#include "host/bvh/flatten.h"
#include "host/bvh/parallel.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {
namespace {

/// A subtree with no more triangles than this is widened by one thread.
constexpr uint kPartTriangles = 1u << 14u;
constexpr std::size_t kBlockGrain = 1u << 10u;

/// A wide node with the boxes of its children, but without references to them.
WideNode make_node(const WideChildren& children) {
    WideNode node{};
    std::fill_n(&node.low[0][0], 3 * NEARLIGHT_WIDE_CHILDREN, kInfinity);
    std::fill_n(&node.high[0][0], 3 * NEARLIGHT_WIDE_CHILDREN, -kInfinity);
    for (std::size_t i = 0; i < children.count; ++i) {
        const Aabb& box = children.children[i].box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.low[axis][i] = (&box.min.x)[axis];
            node.high[axis][i] = (&box.max.x)[axis];
        }
    }
    return node;
}

void put(float (&rows)[3][NEARLIGHT_BLOCK_TRIANGLES], std::size_t column, Vec3 v) {
    rows[0][column] = v.x;
    rows[1][column] = v.y;
    rows[2][column] = v.z;
}
void put(TriangleBlock& block, std::size_t column, const BvhTriangle& triangle) {
    put(block.v0, column, triangle.v0);
    put(block.edge1, column, triangle.edge1);
    put(block.edge2, column, triangle.edge2);
}

/// A block as it is stored. Columns without a triangle stay zero, except for the first: in a tree without
/// triangles it has a degenerate one, whose id is ~0u too.
TriangleBlock fetch_block(const Scene& scene, std::span<const uint> ids) {
    TriangleBlock block{};
    for (std::size_t column = 0; column < ids.size(); ++column) {
        if (column == 0 || ids[column] != ~0u) {
            put(block, column, fetch_triangle(scene, ids[column]));
        }
    }
    return block;
}

/// Widens one subtree, in depth-first order.
class Widener {
  public:
    Widener(const CollapsePlan& plan, uint triangle_count) : plan_(plan) {
        wide_.nodes.reserve(triangle_count / 8 + 1);
        wide_.blocks.reserve(triangle_count / 3 + 1);
        wide_.triangle_ids.reserve(NEARLIGHT_BLOCK_TRIANGLES * (triangle_count / 3 + 1));
    }

    /// Adds the wide form of a binary subtree, and returns the reference to it.
    uint add(uint reference) {
        return plan_.becomes_leaf(reference) ? add_leaf(reference) : add_node(reference);
    }
    /// Adds the wide form of a subtree as an inner node, however few triangles it has, and returns the
    /// reference.
    uint add_node(uint node_index) {
        const WideChildren children = plan_.children(node_index);
        const std::size_t index = wide_.nodes.size();
        wide_.nodes.push_back(make_node(children));
        for (std::size_t i = 0; i < children.count; ++i) {
            const uint child = add(children.children[i].reference);
            wide_.nodes[index].child[i] = child;
        }
        return static_cast<uint>(index);
    }

    WideBvh take() && { return std::move(wide_); }

  private:
    uint add_leaf(uint reference) {
        const std::size_t first = wide_.blocks.size();
        std::size_t count = 0;
        add_triangles(reference, count);
        return leaf_reference(static_cast<uint>(first), static_cast<uint>(wide_.blocks.size() - first));
    }

    void add_triangles(uint reference, std::size_t& count) {
        if (!is_leaf(reference)) {
            add_triangles(plan_.bvh().nodes[reference].left, count);
            add_triangles(plan_.bvh().nodes[reference].right, count);
            return;
        }
        for (uint i = 0; i < leaf_count(reference); ++i) {
            const uint slot = leaf_first(reference) + i;
            const std::size_t column = count++ % NEARLIGHT_BLOCK_TRIANGLES;
            if (column == 0) {
                wide_.blocks.emplace_back();
                wide_.triangle_ids.resize(wide_.triangle_ids.size() + NEARLIGHT_BLOCK_TRIANGLES, ~0u);
            }
            wide_.triangle_ids[wide_.triangle_ids.size() - NEARLIGHT_BLOCK_TRIANGLES + column] =
                plan_.bvh().triangle_ids[slot];
            put(wide_.blocks.back(), column, plan_.bvh().triangles[slot]);
        }
    }

    const CollapsePlan& plan_;
    WideBvh wide_;
};

/// What a thread makes: a subtree, or a single node above subtrees, whose children are later parts.
struct Part {
    uint reference = 0;
    /// Children of a single node, as indices of parts; empty for a subtree.
    std::vector<std::size_t> children;
    WideBvh made;
    uint root = 0;  ///< reference to the root of a subtree, counted from the part's start
    std::size_t node_offset = 0, block_offset = 0;  ///< where the part is put
};

/// Appends the parts of a subtree in depth-first order, and returns the first one's index.
std::size_t list_parts(const CollapsePlan& plan, uint reference, std::vector<Part>& parts) {
    const std::size_t index = parts.size();
    parts.push_back({.reference = reference, .children = {}, .made = {}});
    if (plan.becomes_leaf(reference) || plan.triangle_count(reference) <= kPartTriangles) {
        return index;
    }
    const WideChildren children = plan.children(reference);
    parts[index].made.nodes = {make_node(children)};
    for (std::size_t i = 0; i < children.count; ++i) {
        const std::size_t child = list_parts(plan, children.children[i].reference, parts);
        parts[index].children.push_back(child);
    }
    return index;
}

/// Converts a reference within a part to one within the whole tree.
uint moved(uint reference, const Part& part) {
    return reference + static_cast<uint>(is_leaf(reference) ? part.block_offset : part.node_offset);
}

void copy_part(const Part& part, std::span<const Part> parts, WideBvh& wide) {
    for (std::size_t i = 0; i < part.made.nodes.size(); ++i) {
        WideNode node = part.made.nodes[i];
        for (std::size_t k = 0; k < NEARLIGHT_WIDE_CHILDREN && node.low[0][k] < kInfinity; ++k) {
            if (part.children.empty()) {
                node.child[k] = moved(node.child[k], part);
            } else {
                const Part& child = parts[part.children[k]];
                node.child[k] = moved(child.root, child);
            }
        }
        wide.nodes[part.node_offset + i] = node;
    }
    const auto first_block = static_cast<std::ptrdiff_t>(part.block_offset);
    std::ranges::copy(part.made.blocks, wide.blocks.begin() + first_block);
    std::ranges::copy(part.made.triangle_ids,
                      wide.triangle_ids.begin() + NEARLIGHT_BLOCK_TRIANGLES * first_block);
}

template <typename Body>
void for_each_part(std::vector<Part>& parts, const Body& body) {
    parallel_for(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        std::for_each(parts.begin() + static_cast<std::ptrdiff_t>(first),
                      parts.begin() + static_cast<std::ptrdiff_t>(last), body);
    });
}

}  // namespace

WideBvh widen(const Bvh& bvh) {
    const CollapsePlan plan(bvh);
    std::vector<Part> parts;
    list_parts(plan, 0, parts);
    for_each_part(parts, [&](Part& part) {
        if (part.children.empty()) {
            Widener widener(plan, plan.triangle_count(part.reference));
            part.root = &part == parts.data() ? widener.add_node(0) : widener.add(part.reference);
            part.made = std::move(widener).take();
        }
    });
    std::size_t node_count = 0;
    std::size_t block_count = 0;
    for (Part& part : parts) {
        part.node_offset = node_count;
        part.block_offset = block_count;
        node_count += part.made.nodes.size();
        block_count += part.made.blocks.size();
    }
    WideBvh wide;
    wide.nodes.resize(node_count);
    wide.blocks.resize(block_count);
    wide.triangle_ids.resize(NEARLIGHT_BLOCK_TRIANGLES * block_count);
    for_each_part(parts, [&](const Part& part) { copy_part(part, parts, wide); });
    return wide;
}

void fetch_blocks(WideBvh& wide, const Scene& scene) {
    wide.blocks.resize(wide.triangle_ids.size() / NEARLIGHT_BLOCK_TRIANGLES);
    parallel_for(wide.blocks.size(), kBlockGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            wide.blocks[i] =
                fetch_block(scene, std::span(wide.triangle_ids)
                                       .subspan(NEARLIGHT_BLOCK_TRIANGLES * i, NEARLIGHT_BLOCK_TRIANGLES));
        }
    });
}

}  // namespace nearlight::core
