// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/sah_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/base/division.h"
#include "host/bvh/object_split.h"
#include "host/bvh/spatial_split.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// With fewer references a bin than this, more bins cost time and gain nothing (bench/log/trees.md).
constexpr std::size_t kReferencesPerBin = 8;
constexpr int kMinBinsAskedFor = 8;
constexpr std::size_t kTaskTriangles = 4096;  // smaller subtrees are built by one thread

/// Spatial splits are looked for if the boxes of the best two sets of whole references overlap by more than
/// the first two shares, of the root's and the node's area. They are taken if they lower the cost to the
/// third share. Segments between surfaces, unlike the endless lines of the heuristic, gain nothing from
/// tighter boxes of walls: with 1.0 in place of 0.85 they take more steps, not fewer (bench/log/trees.md).
constexpr float kMinOverlapOfRoot = 1e-5f;
constexpr float kMinOverlapOfNode = 0.2f;
constexpr float kSpatialGain = 0.85f;

/// The number of levels below a node of `count` triangles that is halved until its parts fit into leaves.
int halving_depth(std::size_t count, std::size_t leaf_size) {
    const std::size_t leaves = divide_rounding_up(count, leaf_size);
    return static_cast<int>(std::bit_width(leaves - 1));
}

float overlap_area(const Box4& a, const Box4& b) {
    float size[3];
    for (int i = 0; i < 3; ++i) {
        size[i] = std::min(a.high[i], b.high[i]) - std::max(a.low[i], b.low[i]);
        if (size[i] < 0.0f) {
            return 0.0f;
        }
    }
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

struct Subtree {
    Box4 box;
    uint reference;
    std::size_t inner_count;
    int depth;  ///< depth of the deepest leaf, counted from the root of the whole tree
};

/// A part of the references: `count` of them from `first` on, with room behind them for `capacity` in all.
struct Room {
    std::size_t first;
    std::size_t count;
    std::size_t capacity;
};

RangeBounds bounds_of(std::span<const Reference> range) {
    RangeBounds bounds;
    fold(range, bounds, [](RangeBounds& sum, std::span<const Reference> part) {
        RangeBounds in_registers = sum;
        for (const Reference& reference : part) {
            in_registers.add(reference);
        }
        sum = in_registers;
    });
    return bounds;
}

class SahBuilder {
  public:
    /// If `splitter` is null, every reference stays whole.
    SahBuilder(std::span<Reference> references, std::span<BvhNode> slots, const BvhConfig& config,
               const SpatialSplitter* splitter)
        : references_(references),
          slots_(slots),
          config_(config),
          splitter_(splitter),
          leaf_size_(std::clamp<uint>(config.max_leaf_triangles, 1, NEARLIGHT_LEAF_MAX_TRIANGLES)) {}

    /// Keeps to depth + halving_depth(count) ≤ NEARLIGHT_MAX_BVH_DEPTH, which holds at the root of any tree.
    Subtree build(const Room& room, const RangeBounds& bounds, int depth) {
        const Subtree leaf{bounds.box,
                           leaf_reference(static_cast<uint>(room.first), static_cast<uint>(room.count)), 0,
                           depth};
        if (room.count == 1) {
            return leaf;
        }
        // The larger part of a cost-based split may have all triangles but one, and that of a spatial split
        // all.
        const bool may_be_uneven =
            depth + 1 + halving_depth(room.count, leaf_size_) <= NEARLIGHT_MAX_BVH_DEPTH;
        const auto parts = may_be_uneven ? split_by_cost(room, bounds) : SpatialSplitter::Parts{0, 0};
        if (parts.left_count > 0) {
            return build_children(room, parts, depth);
        }
        if (room.count <= leaf_size_) {
            return leaf;
        }
        split_in_halves(references_.subspan(room.first, room.count), bounds);
        return build_children(room, {(room.count + 1) / 2, room.count / 2}, depth);
    }

  private:
    /// Partitions the range at the cheapest plane. The left part is empty if a leaf is cheaper or no plane
    /// splits the range.
    [[nodiscard]] SpatialSplitter::Parts split_by_cost(const Room& room, const RangeBounds& bounds) const {
        const auto range = references_.subspan(room.first, room.count);
        const std::size_t max_bins =
            static_cast<std::size_t>(std::clamp(config_.bin_count, kMinBinsAskedFor, kMaxBins));
        const int bin_count =
            static_cast<int>(std::min(kMinBins + range.size() / kReferencesPerBin, max_bins));
        const BinMapping mapping(bounds.centers, bin_count);
        const ObjectSplit object = find_object_split(range, mapping);
        const float area = bounds.box.half_area();
        const float leaf_cost = area * (config_.intersection_cost * static_cast<float>(range.size()));
        const auto is_worth_it = [&](float cost) {
            return range.size() > leaf_size_ ||
                   area * config_.traversal_cost + cost * config_.intersection_cost < leaf_cost;
        };
        if (may_split_references(room, bounds, object)) {
            const BinMapping slabs(
                bounds.box, static_cast<int>(std::clamp<std::size_t>(range.size(), kMinSlabs, kMaxSlabs)));
            const SpatialSplit spatial = splitter_->find(range, slabs, kSpatialGain * object.cost);
            const std::size_t total = std::size_t{spatial.left_count} + spatial.right_count;
            if (spatial.axis >= 0 && total <= room.capacity && is_worth_it(spatial.cost)) {
                const auto parts = splitter_->partition(references_.subspan(room.first, room.capacity),
                                                        room.count, slabs, spatial);
                if (parts.left_count > 0 && parts.right_count > 0) {
                    return parts;
                }
            }
        }
        if (!object.found() || !is_worth_it(object.cost)) {
            return {0, 0};
        }
        const std::size_t left = partition(range, mapping, object);
        return {left, range.size() - left};
    }

    [[nodiscard]] bool may_split_references(const Room& room, const RangeBounds& bounds,
                                            const ObjectSplit& object) const {
        if (splitter_ == nullptr || room.capacity == room.count) {
            return false;
        }
        const float overlap =
            object.found() ? overlap_area(object.left, object.right) : bounds.box.half_area();
        return overlap > kMinOverlapOfRoot * splitter_->root_area() &&
               overlap > kMinOverlapOfNode * bounds.box.half_area();
    }

    /// The number of `spare` places that go to the left part, in proportion to the gain from splitting there.
    static std::size_t left_share(const RangeBounds& left, const RangeBounds& right, std::size_t spare) {
        const auto left_weight = static_cast<double>(left.weight);
        const double weight = left_weight + static_cast<double>(right.weight);
        return weight > 0.0 ? static_cast<std::size_t>(static_cast<double>(spare) * (left_weight / weight))
                            : 0;
    }

    Subtree build_children(const Room& room, const SpatialSplitter::Parts& parts, int depth) {
        const RangeBounds left_bounds = bounds_of(references_.subspan(room.first, parts.left_count));
        const RangeBounds right_bounds =
            bounds_of(references_.subspan(room.first + parts.left_count, parts.right_count));
        const std::size_t spare = room.capacity - parts.left_count - parts.right_count;
        const Room left_room{room.first, parts.left_count,
                             parts.left_count + left_share(left_bounds, right_bounds, spare)};
        const Room right_room{room.first + left_room.capacity, parts.right_count,
                              room.capacity - left_room.capacity};
        make_room(room.first + parts.left_count, right_room);
        Subtree left;
        Subtree right;
        const auto build_left = [&] { left = build(left_room, left_bounds, depth + 1); };
        const auto build_right = [&] { right = build(right_room, right_bounds, depth + 1); };
        if (room.count > kTaskTriangles) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
        const auto slot = static_cast<uint>(right_room.first - 1);
        slots_[slot] = {left.box.min(),  left.reference,
                        left.box.max(),  right.reference,
                        right.box.min(), 0,
                        right.box.max(), 0};
        left.box.extend(right.box);
        return {left.box, slot, left.inner_count + right.inner_count + 1, std::max(left.depth, right.depth)};
    }

    /// Moves the right part from `from` to its own room. Its first references go to the back, as order is
    /// free.
    void make_room(std::size_t from, const Room& right_room) {
        const std::size_t moved = std::min(right_room.first - from, right_room.count);
        std::copy_n(
            references_.begin() + static_cast<std::ptrdiff_t>(from), moved,
            references_.begin() + static_cast<std::ptrdiff_t>(right_room.first + right_room.count - moved));
    }

    std::span<Reference> references_;
    std::span<BvhNode> slots_;
    BvhConfig config_;
    const SpatialSplitter* splitter_;
    std::size_t leaf_size_;
};

/// Makes room for `capacity` references, and the first ids.size() of them.
UnsetVector<Reference> make_references(const Scene& scene, std::span<const uint> ids, std::size_t capacity) {
    UnsetVector<Reference> references(capacity);
    parallel_for(ids.size(), kLoopGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            references[i] = make_reference(scene, ids[i]);
        }
    });
    return references;
}

void set_weights(std::span<Reference> references, const SpatialSplitter& splitter) {
    parallel_for(references.size(), kLoopGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            references[i].set_weight(splitter.weight(references[i]));
        }
    });
}

}  // namespace

SahTree build_sah_tree(const Scene& scene, std::span<const uint> ids, const BvhConfig& config) {
    const bool splits = config.quality == BvhQuality::quality;
    const auto wanted = splits ? static_cast<std::size_t>(static_cast<double>(ids.size()) *
                                                          std::clamp(config.max_duplication, 0.0f, 4.0f))
                               : std::size_t{0};
    check_triangle_count(ids.size());
    const std::size_t spare = std::min(wanted, kMaxSceneTriangles - ids.size());
    const std::size_t capacity = ids.size() + spare;
    UnsetVector<Reference> references = make_references(scene, ids, capacity);
    SahTree tree;
    tree.slots.resize(capacity - 1);
    const auto range = std::span(references).first(ids.size());
    const Box4 box = bounds_of(range).box;
    const SpatialSplitter splitter(scene, box);
    const bool may_split = spare > 0 && splitter.usable();
    if (may_split) {
        set_weights(range, splitter);
    }
    SahBuilder builder(references, tree.slots, config, may_split ? &splitter : nullptr);
    const Subtree root =
        builder.build({0, ids.size(), may_split ? capacity : ids.size()}, bounds_of(range), 0);
    tree.root = root.reference;
    tree.root_box = {root.box.min(), root.box.max()};
    tree.inner_count = root.inner_count;
    tree.depth = root.depth;
    tree.order.resize(capacity);
    parallel_for(capacity, kLoopGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            tree.order[i] = references[i].id();
        }
    });
    return tree;
}

}  // namespace nearlight::core
