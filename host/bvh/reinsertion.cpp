// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/reinsertion.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "host/bvh/box4.h"

namespace nearlight::core {
namespace {

/// Bounds of the number of inner nodes that are reinserted; more gain little (bench/log/trees.md).
constexpr std::size_t kMinNodes = 64;
constexpr std::size_t kMaxNodes = 4096;
constexpr std::size_t kInnerNodesPerNode = 32;
constexpr int kPasses = 3;
constexpr float kMaxReinsertionArea = 1e30f;
constexpr uint kNone = ~0u;

Box4 to_box(Vec3 low, Vec3 high) {
    return {{low.x, low.y, low.z, 0.0f}, {high.x, high.y, high.z, 0.0f}};
}

Box4 together(Box4 a, const Box4& b) {
    a.extend(b);
    return a;
}

/// The upper part of a tree: the inner nodes with the largest boxes, and their children.
class TopTree {
  public:
    TopTree(const SahTree& tree, std::size_t inner_count) {
        nodes_.reserve(2 * inner_count + 1);
        nodes_.push_back({to_box(tree.root_box.min, tree.root_box.max), tree.root, kNone});
        std::priority_queue<std::pair<float, uint>> largest;
        largest.push({0.0f, root_});
        for (std::size_t i = 0; i < inner_count && !largest.empty(); ++i) {
            const uint index = largest.top().second;
            largest.pop();
            const BvhNode& slot = tree.slots[nodes_[index].reference];
            nodes_[index].left = add(to_box(slot.left_min, slot.left_max), slot.left, index);
            nodes_[index].right = add(to_box(slot.right_min, slot.right_max), slot.right, index);
            for (const uint child : {nodes_[index].left, nodes_[index].right}) {
                if (!is_leaf(nodes_[child].reference)) {
                    largest.push({nodes_[child].box.half_area(), child});
                }
            }
        }
    }

    /// Reinserts every node once, the largest first. Returns false if all stayed where they were.
    bool reinsert_all() {
        std::vector<uint> order(nodes_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, std::greater{}, [&](uint i) { return nodes_[i].box.half_area(); });
        bool moved = false;
        for (const uint node : order) {
            moved = (node != root_ && reinsert(node)) || moved;
        }
        return moved;
    }

    /// The maximum number of levels that a node has moved down.
    [[nodiscard]] int levels_added() const {
        int result = 0;
        for (uint i = 0; i < nodes_.size(); ++i) {
            if (!is_inner(nodes_[i])) {
                result = std::max(result, level(i) - nodes_[i].level_before);
            }
        }
        return result;
    }

    /// Writes the nodes to `tree`, where every inner node keeps its slot.
    void write_to(SahTree& tree) const {
        for (const Node& node : nodes_) {
            if (is_inner(node)) {
                const Node& left = nodes_[node.left];
                const Node& right = nodes_[node.right];
                tree.slots[node.reference] = {left.box.min(),  left.reference,
                                              left.box.max(),  right.reference,
                                              right.box.min(), 0,
                                              right.box.max(), 0};
            }
        }
        tree.root = nodes_[root_].reference;
    }

  private:
    struct Node {
        Box4 box;
        uint reference;  ///< reference in the tree
        uint parent;
        uint left = kNone;  ///< index into nodes_, as is `right`; kNone if what is below stays as it is
        uint right = kNone;
        int level_before = 0;
    };
    struct Candidate {
        uint node;
        float added_above;  ///< surface that the box adds to the nodes above
    };

    static bool is_inner(const Node& node) { return node.left != kNone; }

    uint add(const Box4& box, uint reference, uint parent) {
        nodes_.push_back({box, reference, parent, kNone, kNone, nodes_[parent].level_before + 1});
        return static_cast<uint>(nodes_.size() - 1);
    }

    [[nodiscard]] int level(uint index) const {
        int result = 0;
        for (uint i = nodes_[index].parent; i != kNone; i = nodes_[i].parent) {
            ++result;
        }
        return result;
    }

    void put_in_place_of(uint old, uint node) {
        const uint parent = nodes_[old].parent;
        nodes_[node].parent = parent;
        if (parent == kNone) {
            root_ = node;
        } else {
            (nodes_[parent].left == old ? nodes_[parent].left : nodes_[parent].right) = node;
        }
    }

    /// Fits the boxes of a node and of all nodes above it to their children.
    void fit_boxes(uint index) {
        for (uint i = index; i != kNone; i = nodes_[i].parent) {
            nodes_[i].box = together(nodes_[nodes_[i].left].box, nodes_[nodes_[i].right].box);
        }
    }

    /// Takes out a node and its parent, and puts both back where the node fits best. Returns whether they
    /// moved.
    bool reinsert(uint index) {
        const uint parent = nodes_[index].parent;
        const uint sibling = nodes_[parent].left == index ? nodes_[parent].right : nodes_[parent].left;
        put_in_place_of(parent, sibling);
        fit_boxes(nodes_[sibling].parent);
        const uint target = find_sibling(nodes_[index].box, sibling);
        put_in_place_of(target, parent);
        nodes_[target].parent = parent;
        nodes_[parent].left = target;
        nodes_[parent].right = index;
        fit_boxes(parent);
        return target != sibling;
    }

    /// The node beside which a box adds the minimum surface; `first` unless another one is better.
    uint find_sibling(const Box4& box, uint first) {
        const float area = box.half_area();
        uint best = first;
        float min_added = together(nodes_[first].box, box).half_area();
        for (uint i = nodes_[first].parent; i != kNone; i = nodes_[i].parent) {
            min_added += together(nodes_[i].box, box).half_area() - nodes_[i].box.half_area();
        }
        candidates_.assign(1, {root_, 0.0f});
        while (!candidates_.empty()) {
            const Candidate candidate = candidates_.back();
            candidates_.pop_back();
            if (candidate.added_above + area >= min_added) {
                continue;
            }
            const Node& node = nodes_[candidate.node];
            const float here = candidate.added_above + together(node.box, box).half_area();
            if (here < min_added) {
                min_added = here;
                best = candidate.node;
            }
            const float added = here - node.box.half_area();
            if (is_inner(node) && added + area < min_added) {
                candidates_.push_back({node.left, added});
                candidates_.push_back({node.right, added});
            }
        }
        return best;
    }

    std::vector<Node> nodes_;
    std::vector<Candidate> candidates_;  ///< scratch memory of find_sibling()
    uint root_ = 0;
};

}  // namespace

void reinsert_largest(SahTree& tree) {
    const float area = to_box(tree.root_box.min, tree.root_box.max).half_area();
    if (is_leaf(tree.root) || !(area > 0.0f && area < kMaxReinsertionArea)) {
        return;
    }
    TopTree top(tree, std::clamp(tree.inner_count / kInnerNodesPerNode, kMinNodes, kMaxNodes));
    for (int pass = 0; pass < kPasses && top.reinsert_all(); ++pass) {}
    const int depth = tree.depth + top.levels_added();
    if (depth <= NEARLIGHT_MAX_BVH_DEPTH) {
        top.write_to(tree);
        tree.depth = depth;
    }
}

}  // namespace nearlight::core
