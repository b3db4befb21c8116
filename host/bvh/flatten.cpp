// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/flatten.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "host/base/division.h"
#include "host/bvh/parallel.h"

namespace nearlight::core {
namespace {

/// The coordinate of boxes and triangles that no ray shall meet: far, but distances to it do not overflow.
constexpr float kFar = 1e30f;
constexpr std::size_t kFetchGrain = 1u << 12u;
constexpr Vec3 kFarPoint{kFar, kFar, kFar};
constexpr BvhTriangle kNoTriangle{kFarPoint, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

struct Counts {
    uint nodes = 0;
    uint triangles = 0;
    int levels = 0;  ///< levels of inner nodes; unused in the counts before a subtree
};

/// Counts a subtree, and stores the counts of each left subtree in the free words of its parent.
Counts count_below(SahTree& tree, uint reference, int level) {
    if (is_leaf(reference)) {
        return {0, leaf_count(reference), 0};
    }
    BvhNode& slot = tree.slots[reference];
    Counts left;
    Counts right;
    invoke_at_level(
        level, [&] { left = count_below(tree, slot.left, level + 1); },
        [&] { right = count_below(tree, slot.right, level + 1); });
    slot.pad0 = left.nodes;
    slot.pad1 = left.triangles;
    return {left.nodes + right.nodes + 1, left.triangles + right.triangles,
            std::max(left.levels, right.levels) + 1};
}

/// Puts the subtree and the triangles of its leaves at their places in depth-first order, and returns the
/// reference to it.
uint place(const SahTree& tree, uint reference, Counts before, Bvh& bvh, int level) {
    if (is_leaf(reference)) {
        std::copy_n(tree.order.begin() + leaf_first(reference), leaf_count(reference),
                    bvh.triangle_ids.begin() + before.triangles);
        return leaf_reference(before.triangles, leaf_count(reference));
    }
    BvhNode node = tree.slots[reference];
    const Counts before_right{before.nodes + 1 + node.pad0, before.triangles + node.pad1};
    node.pad0 = node.pad1 = 0;
    uint left = 0;
    uint right = 0;
    invoke_at_level(
        level,
        [&] {
            left = place(tree, node.left, {before.nodes + 1, before.triangles}, bvh, level + 1);
        },
        [&] { right = place(tree, node.right, before_right, bvh, level + 1); });
    node.left = left;
    node.right = right;
    bvh.nodes[before.nodes] = node;
    return before.nodes;
}

BvhNode root_of_one_leaf(const Aabb& box, uint leaf) {
    return {box.min, leaf, box.max, leaf, kFarPoint, 0, kFarPoint, 0};
}

/// Double precision keeps squares of huge extents in range.
double half_area(Vec3 low, Vec3 high) {
    const double x = static_cast<double>(high.x) - low.x;
    const double y = static_cast<double>(high.y) - low.y;
    const double z = static_cast<double>(high.z) - low.z;
    return x * y + y * z + z * x;
}

}  // namespace

BvhTriangle fetch_triangle(const Scene& scene, uint id) {
    if (id == ~0u) {
        return kNoTriangle;
    }
    const Triangle& triangle = scene.triangles[id];
    const Vec3 v0 = scene.vertices[triangle.v0].position;
    const Vec3 edge1 = scene.vertices[triangle.v1].position - v0;
    const Vec3 edge2 = scene.vertices[triangle.v2].position - v0;
    return {v0, edge1, edge2, cross(edge1, edge2)};
}

void fetch_triangles(Bvh& bvh, const Scene& scene) {
    bvh.triangles.resize(bvh.triangle_ids.size());
    parallel_for(bvh.triangles.size(), kFetchGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            bvh.triangles[i] = fetch_triangle(scene, bvh.triangle_ids[i]);
        }
    });
}

Bvh empty_bvh() {
    Bvh bvh;
    bvh.nodes = {root_of_one_leaf({kFarPoint, kFarPoint}, leaf_reference(0, 1))};
    bvh.triangles = {kNoTriangle};
    bvh.triangle_ids = {~0u};
    bvh.depth = 1;
    return bvh;
}

Bvh flatten(SahTree&& tree, const Scene& scene, const BvhConfig& config) {
    Bvh bvh;
    const Counts counts = count_below(tree, tree.root, 0);
    bvh.nodes.resize(counts.nodes);
    bvh.triangle_ids.resize(counts.triangles);
    const uint root = place(tree, tree.root, {}, bvh, 0);
    bvh.depth = counts.levels;
    if (is_leaf(root)) {
        bvh.nodes = {root_of_one_leaf(tree.root_box, root)};
        bvh.depth = 1;
    }
    tree = {};  // frees its memory before the triangles need theirs
    fetch_triangles(bvh, scene);
    bvh.sah_cost = sah_cost(bvh, config);
    return bvh;
}

double sah_cost(const Bvh& bvh, const BvhConfig& config) {
    const BvhNode& root = bvh.nodes.front();
    if (root.left == root.right) {
        return static_cast<double>(config.traversal_cost) +
               leaf_count(root.left) * static_cast<double>(config.intersection_cost);
    }
    const double root_area =
        half_area(min(root.left_min, root.right_min), max(root.left_max, root.right_max));
    const auto child_cost = [&](uint child, Vec3 low, Vec3 high) {
        const double cost = is_leaf(child) ? leaf_count(child) * static_cast<double>(config.intersection_cost)
                                           : static_cast<double>(config.traversal_cost);
        return root_area > 0.0 ? cost * half_area(low, high) / root_area : cost;
    };
    // Runs of fixed length are summed separately, so that the sum does not depend on the threads.
    std::vector<double> sums(divide_rounding_up(bvh.nodes.size(), kFetchGrain));
    parallel_for(sums.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t run = first; run < last; ++run) {
            const auto nodes = std::span(bvh.nodes).subspan(run * kFetchGrain);
            for (const BvhNode& node : nodes.first(std::min(nodes.size(), kFetchGrain))) {
                sums[run] += child_cost(node.left, node.left_min, node.left_max) +
                             child_cost(node.right, node.right_min, node.right_max);
            }
        }
    });
    return std::accumulate(sums.begin(), sums.end(), static_cast<double>(config.traversal_cost));
}

}  // namespace nearlight::core
