// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/collapse_plan.h"

#include <algorithm>
#include <limits>

#include "host/bvh/parallel.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {
namespace {

WideChild left_child(const BvhNode& node) {
    return {node.left, {node.left_min, node.left_max}};
}
WideChild right_child(const BvhNode& node) {
    return {node.right, {node.right_min, node.right_max}};
}
/// False in a tree of one leaf, to which the root refers twice.
bool has_right(const BvhNode& node) {
    return node.right != node.left;
}

}  // namespace

CollapsePlan::CollapsePlan(const Bvh& bvh) : bvh_(&bvh), plans_(bvh.nodes.size()) {
    plan(0, 0.0f, 0);  // the surface of the root does not matter
}

uint CollapsePlan::triangle_count(uint reference) const {
    return is_leaf(reference) ? leaf_count(reference) : plans_[reference].triangles;
}

float CollapsePlan::cost(const WideChild& child, std::size_t max_children) const {
    return is_leaf(child.reference) ? 0.0f : plans_[child.reference].cost[max_children];
}

void CollapsePlan::plan(uint node_index, float half_area, int level) {
    const BvhNode& node = bvh_->nodes[node_index];
    Plan plan;
    const auto plan_below = [&](const WideChild& child) {
        if (!is_leaf(child.reference)) {
            this->plan(child.reference, child.box.half_area(), level + 1);
        }
    };
    invoke_at_level(
        level, [&] { plan_below(left_child(node)); }, [&] { plan_below(right_child(node)); });
    plan.triangles = triangle_count(node.left) + (has_right(node) ? triangle_count(node.right) : 0);
    plan.is_leaf = plan.triangles <= NEARLIGHT_BLOCK_TRIANGLES;
    if (!plan.is_leaf) {
        divide(plan, node, half_area);
    }
    plans_[node_index] = plan;
}

void CollapsePlan::divide(Plan& plan, const BvhNode& node, float half_area) const {
    std::array<float, kMax + 1> divided{};
    for (std::size_t max_children = 2; max_children <= kMax; ++max_children) {
        divided[max_children] = std::numeric_limits<float>::infinity();
        for (std::size_t left = 1; left < max_children; ++left) {
            const float both = cost(left_child(node), left) + cost(right_child(node), max_children - left);
            if (both < divided[max_children]) {
                divided[max_children] = both;
                plan.left[max_children] = static_cast<std::uint8_t>(left);
            }
        }
    }
    plan.left_of_all = plan.left[kMax];
    plan.cost[1] = half_area + divided[kMax];
    for (std::size_t max_children = 2; max_children <= kMax; ++max_children) {
        plan.cost[max_children] = std::min(plan.cost[1], divided[max_children]);
        plan.left[max_children] =
            divided[max_children] < plan.cost[1] ? plan.left[max_children] : std::uint8_t{0};
    }
}

bool CollapsePlan::becomes_leaf(uint reference) const {
    return is_leaf(reference) || plans_[reference].is_leaf;
}

void CollapsePlan::take(const WideChild& child, std::size_t max_children, WideChildren& children) const {
    const std::size_t left = is_leaf(child.reference) ? 0 : plans_[child.reference].left[max_children];
    if (left == 0) {
        children.children[children.count++] = child;
        return;
    }
    const BvhNode& node = bvh_->nodes[child.reference];
    take(left_child(node), left, children);
    take(right_child(node), max_children - left, children);
}

WideChildren CollapsePlan::children(uint node_index) const {
    const BvhNode& node = bvh_->nodes[node_index];
    WideChildren result;
    if (!has_right(node)) {
        take(left_child(node), 1, result);
        return result;
    }
    // A root with no more triangles than a block is divided all the same.
    const std::size_t left = std::max<std::size_t>(1, plans_[node_index].left_of_all);
    take(left_child(node), left, result);
    take(right_child(node), kMax - left, result);
    const auto end = result.children.begin() + static_cast<std::ptrdiff_t>(result.count);
    std::stable_sort(result.children.begin(), end, [](const WideChild& a, const WideChild& b) {
        return a.box.half_area() < b.box.half_area();
    });
    return result;
}

}  // namespace nearlight::core
