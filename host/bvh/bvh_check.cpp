// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "host/base/math.h"
#include "host/bvh/bvh.h"
#include "host/bvh/flatten.h"
#include "host/bvh/sah_builder.h"

namespace nearlight::core {
namespace {

constexpr int kCoverSteps = 24;

bool contains(const Aabb& outer, Vec3 p) {
    return min(outer.min, p) == outer.min && max(outer.max, p) == outer.max;
}

Aabb intersection(const Aabb& a, const Aabb& b) {
    return {max(a.min, b.min), min(a.max, b.max)};
}

/// An entry of a cut triangle. Rays can meet only the part of it that lies in all boxes above.
struct CutTriangle {
    uint triangle;
    Aabb box;
};

/// Traverses the tree and collects complaints.
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
        count_entries();
        visit_node(0, 0, {Vec3{-kInfinity, -kInfinity, -kInfinity}, Vec3{kInfinity, kInfinity, kInfinity}});
        check_visits();
        check_ids(ids);
        check_parts();
        if (deepest_ != bvh_.depth) {
            complain("depth is " + std::to_string(deepest_) + ", said to be " + std::to_string(bvh_.depth));
        }
        return std::move(complaints_);
    }

  private:
    void complain(const std::string& text) { complaints_.push_back(text); }

    void count_entries() {
        entries_.assign(scene_.triangles.size(), 0);
        for (const uint id : bvh_.triangle_ids) {
            if (id < entries_.size()) {
                ++entries_[id];
            }
        }
    }

    /// Returns the box of all vertices of whole triangles below the node. `within` is common to all boxes
    /// above.
    Aabb visit_node(uint index, int depth, const Aabb& within) {
        ++node_visits_[index];
        const BvhNode& node = bvh_.nodes[index];
        const std::string name = "node " + std::to_string(index);
        Aabb box = visit_child(node.left, {node.left_min, node.left_max}, depth + 1, name + " left", within);
        const bool single = index == 0 && is_leaf(node.left) && node.right == node.left;
        if (!single) {
            box.extend(visit_child(node.right, {node.right_min, node.right_max}, depth + 1, name + " right",
                                   within));
        }
        return box;
    }

    Aabb visit_child(uint reference, const Aabb& box, int depth, const std::string& name,
                     const Aabb& within) {
        Aabb below;
        if (is_leaf(reference)) {
            below = visit_leaf(reference, depth, name, intersection(within, box));
        } else if (reference >= bvh_.nodes.size() || node_visits_[reference] > 0) {
            complain(name + ": refers to node " + std::to_string(reference) +
                     (reference >= bvh_.nodes.size() ? ", out of range" : ", already in the tree"));
            return below;
        } else if (depth >= NEARLIGHT_MAX_BVH_DEPTH) {
            complain(name + ": deeper than " + std::to_string(NEARLIGHT_MAX_BVH_DEPTH));
            return below;
        } else {
            below = visit_node(reference, depth, intersection(within, box));
        }
        if (!below.is_empty() && !(contains(box, below.min) && contains(box, below.max))) {
            complain(name + ": box does not hold what is below");
        }
        return below;
    }

    Aabb visit_leaf(uint reference, int depth, const std::string& name, const Aabb& within) {
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
                const Aabb whole = check_triangle(i, scene_.triangles[id]);
                if (entries_[id] == 1) {
                    box.extend(whole);
                } else {
                    parts_.push_back({id, within});
                }
            }
        }
        return box;
    }

    /// Compares entry i with the scene's triangle, and returns the box of the latter.
    Aabb check_triangle(uint i, const Triangle& triangle) {
        const Vec3 v0 = scene_.vertices[triangle.v0].position;
        const Vec3 v1 = scene_.vertices[triangle.v1].position;
        const Vec3 v2 = scene_.vertices[triangle.v2].position;
        const BvhTriangle& copy = bvh_.triangles[i];
        if (!(copy.v0 == v0 && copy.edge1 == v1 - v0 && copy.edge2 == v2 - v0)) {
            complain("triangle " + std::to_string(i) + ": differs from that of the scene");
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

    /// Checks that the tree holds exactly `ids`, or the entries of empty_bvh() if there are none.
    void check_ids(std::span<const uint> ids) {
        std::vector<uint> wanted(ids.begin(), ids.end());
        if (wanted.empty()) {
            wanted = empty_bvh().triangle_ids;
        }
        std::sort(wanted.begin(), wanted.end());
        if (wanted != distinct_triangles(bvh_)) {
            complain("the tree holds other triangles than asked for");
        }
    }

    /// Checks that points all over a cut triangle each lie in a box of one of its entries.
    void check_parts() {
        std::stable_sort(parts_.begin(), parts_.end(),
                         [](const CutTriangle& a, const CutTriangle& b) { return a.triangle < b.triangle; });
        for (auto first = parts_.begin(); first != parts_.end();) {
            const auto last = std::find_if(first, parts_.end(), [&](const CutTriangle& part) {
                return part.triangle != first->triangle;
            });
            check_cover({first, last});
            first = last;
        }
    }

    void check_cover(std::span<const CutTriangle> parts) {
        const Triangle& triangle = scene_.triangles[parts.front().triangle];
        const Vec3 v0 = scene_.vertices[triangle.v0].position;
        const Vec3 edge1 = scene_.vertices[triangle.v1].position - v0;
        const Vec3 edge2 = scene_.vertices[triangle.v2].position - v0;
        for (int i = 0; i <= kCoverSteps; ++i) {
            for (int j = 0; i + j <= kCoverSteps; ++j) {
                const Vec3 p = v0 + edge1 * (static_cast<float>(i) / kCoverSteps) +
                               edge2 * (static_cast<float>(j) / kCoverSteps);
                if (std::none_of(parts.begin(), parts.end(),
                                 [&](const CutTriangle& part) { return contains(part.box, p); })) {
                    complain("scene triangle " + std::to_string(parts.front().triangle) +
                             ": its parts leave a hole");
                    return;
                }
            }
        }
    }

    const Bvh& bvh_;
    const Scene& scene_;
    std::vector<int> node_visits_;
    std::vector<int> triangle_visits_;
    std::vector<uint> entries_;  ///< number of entries of each triangle of the scene
    std::vector<CutTriangle> parts_;
    std::vector<std::string> complaints_;
    int deepest_ = 0;
};

}  // namespace

std::vector<std::string> check_bvh(const Bvh& bvh, const Scene& scene, std::span<const uint> ids) {
    return Checker(bvh, scene).check(ids);
}

}  // namespace nearlight::core
