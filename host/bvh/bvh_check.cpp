// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "host/bvh/bvh.h"
#include "host/bvh/flatten.h"
#include "host/bvh/sah_builder.h"

namespace nearlight {
namespace {

bool contains(const Aabb& outer, Vec3 p) {
    return min(outer.min, p) == outer.min && max(outer.max, p) == outer.max;
}

/// Walks the tree and gathers complaints.
class Checker {
  public:
    Checker(const Bvh& bvh, const Scene& scene) : bvh_(bvh), scene_(scene) {}

    std::vector<std::string> check(std::span<const uint> ids) {
        if (bvh_.nodes.empty() || bvh_.triangles.empty() ||
            bvh_.triangles.size() != bvh_.triangle_ids.size()) {
            return {"arrays are empty or of unequal length"};
        }
        node_visits_.assign(bvh_.nodes.size(), 0);
        triangle_visits_.assign(bvh_.triangles.size(), 0);
        visit_node(0, 0);
        check_visits();
        check_ids(ids);
        if (deepest_ != bvh_.depth) {
            complain("depth is " + std::to_string(deepest_) + ", said to be " + std::to_string(bvh_.depth));
        }
        return std::move(complaints_);
    }

  private:
    void complain(const std::string& text) { complaints_.push_back(text); }

    /// Returns the box of all vertices below.
    Aabb visit_node(uint index, int depth) {
        ++node_visits_[index];
        const BvhNode& node = bvh_.nodes[index];
        const std::string name = "node " + std::to_string(index);
        Aabb box = visit_child(node.left, {node.left_min, node.left_max}, depth + 1, name + " left");
        const bool single = index == 0 && is_leaf(node.left) && node.right == node.left;
        if (!single) {
            box.extend(visit_child(node.right, {node.right_min, node.right_max}, depth + 1, name + " right"));
        }
        return box;
    }

    Aabb visit_child(uint reference, const Aabb& box, int depth, const std::string& name) {
        Aabb below;
        if (is_leaf(reference)) {
            below = visit_leaf(reference, depth, name);
        } else if (reference >= bvh_.nodes.size() || node_visits_[reference] > 0) {
            complain(name + ": refers to node " + std::to_string(reference) +
                     (reference >= bvh_.nodes.size() ? ", out of range" : ", already in the tree"));
            return below;
        } else if (depth >= NEARLIGHT_MAX_BVH_DEPTH) {
            complain(name + ": deeper than " + std::to_string(NEARLIGHT_MAX_BVH_DEPTH));
            return below;
        } else {
            below = visit_node(reference, depth);
        }
        if (!below.is_empty() && !(contains(box, below.min) && contains(box, below.max))) {
            complain(name + ": box does not hold what is below");
        }
        return below;
    }

    Aabb visit_leaf(uint reference, int depth, const std::string& name) {
        Aabb box;
        deepest_ = std::max(deepest_, depth);
        const uint first = leaf_first(reference);
        if (first + leaf_count(reference) > bvh_.triangles.size()) {
            complain(name + ": leaf out of range");
            return box;
        }
        for (uint i = first; i < first + leaf_count(reference); ++i) {
            ++triangle_visits_[i];
            const uint id = bvh_.triangle_ids[i];
            if (id < scene_.triangles.size()) {
                box.extend(check_triangle(i, scene_.triangles[id]));
            }
        }
        return box;
    }

    /// Returns the box of the scene's triangle.
    Aabb check_triangle(uint i, const Triangle& triangle) {
        const Vec3 v0 = scene_.vertices[triangle.v0].position;
        const Vec3 v1 = scene_.vertices[triangle.v1].position;
        const Vec3 v2 = scene_.vertices[triangle.v2].position;
        const BvhTriangle& copy = bvh_.triangles[i];
        if (!(copy.v0 == v0 && copy.edge1 == v1 - v0 && copy.edge2 == v2 - v0)) {
            complain("triangle " + std::to_string(i) + ": not the one of the scene");
        }
        const Vec3 normal = cross(copy.edge1, copy.edge2);
        if (is_finite(normal) && !(copy.normal == normal)) {
            complain("triangle " + std::to_string(i) + ": normal is not that of its edges");
        }
        Aabb box;
        box.extend(v0);
        box.extend(v1);
        box.extend(v2);
        return box;
    }

    void check_visits() {
        for (std::size_t i = 0; i < node_visits_.size(); ++i) {
            if (node_visits_[i] == 0) {
                complain("node " + std::to_string(i) + ": not in the tree");
            }
        }
        for (std::size_t i = 0; i < triangle_visits_.size(); ++i) {
            if (triangle_visits_[i] != 1) {
                complain("triangle " + std::to_string(i) + ": in " + std::to_string(triangle_visits_[i]) +
                         " leaves");
            }
        }
    }

    /// Both hold the same ids; those of a tree without triangles are the ones of empty_bvh().
    void check_ids(std::span<const uint> ids) {
        std::vector<uint> wanted(ids.begin(), ids.end());
        if (wanted.empty()) {
            wanted = empty_bvh().triangle_ids;
        }
        std::vector<uint> present = bvh_.triangle_ids;
        std::sort(wanted.begin(), wanted.end());
        std::sort(present.begin(), present.end());
        if (wanted != present) {
            complain("the tree holds other triangles than asked for");
        }
    }

    const Bvh& bvh_;
    const Scene& scene_;
    std::vector<int> node_visits_;
    std::vector<int> triangle_visits_;
    std::vector<std::string> complaints_;
    int deepest_ = 0;
};

}  // namespace

std::vector<std::string> check_bvh(const Bvh& bvh, const Scene& scene, std::span<const uint> ids) {
    return Checker(bvh, scene).check(ids);
}

}  // namespace nearlight
