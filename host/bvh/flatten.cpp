// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/flatten.h"

#include <utility>

#include "host/bvh/parallel.h"

namespace nearlight {
namespace {

/// Where boxes and triangles are that nothing shall meet; far, yet its distances do not overflow.
constexpr float kFar = 1e30f;
constexpr std::size_t kFetchGrain = 1u << 12u;
constexpr Vec3 kFarPoint{kFar, kFar, kFar};

/// Appends the subtree in depth-first order, its leaves' triangles too, and returns the reference to it.
uint append(const SahTree& tree, uint reference, Bvh& bvh) {
    if (is_leaf(reference)) {
        const auto first = static_cast<uint>(bvh.triangle_ids.size());
        const auto begin = tree.order.begin() + leaf_first(reference);
        bvh.triangle_ids.insert(bvh.triangle_ids.end(), begin, begin + leaf_count(reference));
        return leaf_reference(first, leaf_count(reference));
    }
    const auto index = static_cast<uint>(bvh.nodes.size());
    bvh.nodes.push_back(tree.slots[reference]);
    const uint left = append(tree, tree.slots[reference].left, bvh);
    const uint right = append(tree, tree.slots[reference].right, bvh);
    bvh.nodes[index].left = left;
    bvh.nodes[index].right = right;
    return index;
}

BvhTriangle fetch_triangle(const Scene& scene, const Triangle& triangle) {
    const Vec3 v0 = scene.vertices[triangle.v0].position;
    const Vec3 edge1 = scene.vertices[triangle.v1].position - v0;
    const Vec3 edge2 = scene.vertices[triangle.v2].position - v0;
    return {v0, edge1, edge2, cross(edge1, edge2)};
}

BvhNode root_of_one_leaf(const Aabb& box, uint leaf) {
    return {box.min, leaf, box.max, leaf, kFarPoint, 0, kFarPoint, 0};
}

/// In double precision: squares of huge extents stay in range.
double half_area(Vec3 low, Vec3 high) {
    const double x = static_cast<double>(high.x) - low.x;
    const double y = static_cast<double>(high.y) - low.y;
    const double z = static_cast<double>(high.z) - low.z;
    return x * y + y * z + z * x;
}

}  // namespace

Bvh empty_bvh() {
    Bvh bvh;
    bvh.nodes = {root_of_one_leaf({kFarPoint, kFarPoint}, leaf_reference(0, 1))};
    bvh.triangles = {{kFarPoint, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    bvh.triangle_ids = {~0u};
    bvh.depth = 1;
    return bvh;
}

Bvh flatten(SahTree&& tree, const Scene& scene, const BvhConfig& config) {
    Bvh bvh;
    if (is_leaf(tree.root)) {
        bvh.nodes = {root_of_one_leaf(tree.root_box, append(tree, tree.root, bvh))};
        bvh.depth = 1;
    } else {
        bvh.nodes.reserve(tree.inner_count);
        bvh.triangle_ids.reserve(tree.order.size());
        append(tree, tree.root, bvh);
        bvh.triangle_ids.shrink_to_fit();
        bvh.depth = tree.depth;
    }
    tree = {};  // before the triangles need memory
    bvh.triangles.resize(bvh.triangle_ids.size());
    parallel_for(bvh.triangles.size(), kFetchGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            bvh.triangles[i] = fetch_triangle(scene, scene.triangles[bvh.triangle_ids[i]]);
        }
    });
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
    double sum = config.traversal_cost;
    for (const BvhNode& node : bvh.nodes) {
        sum += child_cost(node.left, node.left_min, node.left_max);
        sum += child_cost(node.right, node.right_min, node.right_max);
    }
    return sum;
}

}  // namespace nearlight
