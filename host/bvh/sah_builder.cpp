// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/sah_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "host/base/error.h"
#include "host/bvh/box4.h"
#include "host/bvh/parallel.h"

namespace nearlight {
namespace {

constexpr std::size_t kTaskTriangles = 4096;      // smaller subtrees are built by one thread
constexpr std::size_t kParallelLoop = 1u << 16u;  // shorter loops are not shared between threads
constexpr std::size_t kLoopGrain = 1u << 14u;
constexpr int kMinBins = 8;
constexpr int kMaxBins = 64;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The padded box of a triangle, which carries its index in the free lane: 32 bytes that stay together when
/// partitioning, so that every loop runs through memory in order.
struct Reference : Box4 {
    [[nodiscard]] uint id() const { return std::bit_cast<uint>(low[3]); }
    void set_id(uint id) { low[3] = std::bit_cast<float>(id); }
};

/// Every box is padded by two ulps of its largest coordinate. Without that, the box of an axis-aligned
/// triangle has no thickness, its two slab distances differ by nothing but rounding, and a ray that hits the
/// triangle (or runs exactly along the face of a box) may find the interval empty. Adding +0 turns −0 into
/// +0: of two equal zeros a minimum keeps the one that came first, which would depend on the threads.
Reference make_reference(const Scene& scene, uint id) {
    const Triangle& triangle = scene.triangles[id];
    Aabb box;
    box.extend(scene.vertices[triangle.v0].position);
    box.extend(scene.vertices[triangle.v1].position);
    box.extend(scene.vertices[triangle.v2].position);
    const float pad =
        0x1p-22f * std::max(max_component(max(box.max, -box.max)), max_component(max(box.min, -box.min)));
    const auto set = [pad](float& low, float& high, float min, float max) {
        low = (min - pad) + 0.0f;
        high = (max + pad) + 0.0f;
    };
    Reference reference{};
    set(reference.low[0], reference.high[0], box.min.x, box.max.x);
    set(reference.low[1], reference.high[1], box.min.y, box.max.y);
    set(reference.low[2], reference.high[2], box.min.z, box.max.z);
    reference.set_id(id);
    return reference;
}

struct RangeBounds {
    Box4 box = Box4::empty();
    Box4 centers = Box4::empty();

    void add(const Reference& reference) {
        box.extend(reference);
        centers.extend_by_center(reference);
    }
    void add(const RangeBounds& other) {
        box.extend(other.box);
        centers.extend(other.centers);
    }
};

/// Maps centres to bins.
class BinMapping {
  public:
    BinMapping(const Box4& centers, int bin_count) : last_(static_cast<float>(bin_count - 1)) {
        for (int axis = 0; axis < 3; ++axis) {
            const float size = centers.high[axis] - centers.low[axis];
            low_[axis] = centers.low[axis];
            // 0 sends everything to the first bin: no extent, or one that overflows.
            scale_[axis] = size > 0.0f && std::isfinite(size) ? static_cast<float>(bin_count) / size : 0.0f;
        }
    }
    [[nodiscard]] int operator()(const float* center, int axis) const {
        const float x = (center[axis] - low_[axis]) * scale_[axis];
        return x > 0.0f ? static_cast<int>(std::min(x, last_)) : 0;  // not-a-number goes to 0 as well
    }

  private:
    float low_[3];
    float scale_[3];
    float last_;
};

struct Bin {
    Box4 box;
    uint count;

    void add(const Bin& other) {
        box.extend(other.box);
        count += other.count;
    }
};
constexpr Bin kEmptyBin{Box4::empty(), 0};

struct Bins {
    explicit Bins(int count) : bin_count(count) {
        for (auto& axis : bins) {
            std::fill_n(axis.begin(), count, kEmptyBin);
        }
    }
    void add(const Reference& reference, const BinMapping& mapping) {
        alignas(16) float center[4];
        reference.get_center(center);
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][mapping(center, axis)];
            bin.box.extend(reference);
            ++bin.count;
        }
    }
    void add(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = 0; i < bin_count; ++i) {
                bins[axis][i].add(other.bins[axis][i]);
            }
        }
    }

    int bin_count;
    std::array<std::array<Bin, kMaxBins>, 3> bins;  // those beyond bin_count are never touched
};

/// Folds a range of references into `sum`, which is empty. Minima, maxima and counts do not depend on the
/// order in which threads come by, so neither does the result.
template <typename Sum, typename Add>
void fold(std::span<const Reference> range, Sum& sum, const Add& add) {
    const auto add_part = [&](Sum& partial, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            add(partial, range[i]);
        }
    };
    if (range.size() < kParallelLoop) {
        add_part(sum, 0, range.size());
    } else {
        sum = parallel_sum(range.size(), kLoopGrain, sum, add_part);
    }
}

struct Split {
    float cost = kInfinity;  ///< Σ half area · triangles of both sides
    int axis = -1;
    int last_left_bin = 0;
};

/// The cheapest plane between bins of one axis, if it beats `best`.
Split better_split(const Bins& bins, int axis, Split best) {
    std::array<float, kMaxBins> right_cost;
    Bin right = kEmptyBin;
    for (int i = bins.bin_count - 1; i > 0; --i) {
        right.add(bins.bins[axis][i]);
        right_cost[i] = right.count > 0 ? right.box.half_area() * static_cast<float>(right.count) : kInfinity;
    }
    Bin left = kEmptyBin;
    for (int i = 0; i + 1 < bins.bin_count; ++i) {
        left.add(bins.bins[axis][i]);
        if (left.count == 0) {
            continue;
        }
        const float cost = left.box.half_area() * static_cast<float>(left.count) + right_cost[i + 1];
        if (cost < best.cost) {
            best = {cost, axis, i};
        }
    }
    return best;
}

/// Levels below a node of `count` triangles that is halved until its parts fit into leaves.
int halving_depth(std::size_t count, std::size_t leaf_size) {
    const std::size_t leaves = (count + leaf_size - 1) / leaf_size;
    return static_cast<int>(std::bit_width(leaves - 1));
}

struct Subtree {
    Box4 box;
    uint reference;
    std::size_t inner_count;
    int depth;  ///< of the deepest leaf, counted from the root of the whole tree
};

class SahBuilder {
  public:
    SahBuilder(std::span<Reference> references, std::span<BvhNode> slots, const BvhConfig& config)
        : references_(references),
          slots_(slots),
          config_(config),
          leaf_size_(std::clamp<uint>(config.max_leaf_triangles, 1, NEARLIGHT_LEAF_MAX_TRIANGLES)) {}

    /// Of the references from `first` up to but not including `end`, at `depth`. Keeps to
    /// depth + halving_depth(count) ≤ NEARLIGHT_MAX_BVH_DEPTH, which holds at the root of any tree.
    Subtree build(std::size_t first, std::size_t end, int depth) {
        const std::size_t count = end - first;
        const auto range = references_.subspan(first, count);
        RangeBounds bounds;
        fold(range, bounds, [](RangeBounds& sum, const Reference& r) { sum.add(r); });
        const Subtree leaf{bounds.box, leaf_reference(static_cast<uint>(first), static_cast<uint>(count)), 0,
                           depth};
        if (count == 1) {
            return leaf;
        }
        // The larger part of a cost-based split may have all triangles but one.
        const bool may_be_uneven = depth + 1 + halving_depth(count, leaf_size_) <= NEARLIGHT_MAX_BVH_DEPTH;
        const std::size_t middle = may_be_uneven ? split_by_cost(range, bounds) : 0;
        if (middle > 0) {
            return build_children(first, first + middle, end, depth);
        }
        if (count <= leaf_size_) {
            return leaf;
        }
        split_in_halves(range, bounds);
        return build_children(first, first + (count + 1) / 2, end, depth);
    }

  private:
    /// Partitions the range at the cheapest plane and returns the size of its left part; 0 where a leaf is
    /// cheaper or no plane parts the centres.
    std::size_t split_by_cost(std::span<Reference> range, const RangeBounds& bounds) const {
        const int bin_count = static_cast<int>(std::clamp<std::size_t>(
            range.size(), kMinBins,
            static_cast<std::size_t>(std::clamp(config_.bin_count, kMinBins, kMaxBins))));
        const BinMapping mapping(bounds.centers, bin_count);
        Bins bins(bin_count);
        fold(range, bins, [&](Bins& sum, const Reference& r) { sum.add(r, mapping); });
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            best = better_split(bins, axis, best);
        }
        const float area = bounds.box.half_area();
        const float leaf_cost = area * (config_.intersection_cost * static_cast<float>(range.size()));
        const float split_cost = area * config_.traversal_cost + best.cost * config_.intersection_cost;
        if (best.axis < 0 || (range.size() <= leaf_size_ && !(split_cost < leaf_cost))) {
            return 0;
        }
        const auto right = std::partition(range.begin(), range.end(), [&](const Reference& reference) {
            alignas(16) float center[4];
            reference.get_center(center);
            return mapping(center, best.axis) <= best.last_left_bin;
        });
        return static_cast<std::size_t>(right - range.begin());
    }

    /// Puts the lower half along the longest axis of the centres first.
    static void split_in_halves(std::span<Reference> range, const RangeBounds& bounds) {
        const int axis = bounds.centers.longest_axis();
        const auto key = [axis](const Reference& r) { return 0.5f * r.low[axis] + 0.5f * r.high[axis]; };
        std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>((range.size() + 1) / 2),
                         range.end(), [&](const Reference& a, const Reference& b) {
                             return key(a) != key(b) ? key(a) < key(b) : a.id() < b.id();
                         });
    }

    Subtree build_children(std::size_t first, std::size_t middle, std::size_t end, int depth) {
        Subtree left;
        Subtree right;
        const auto build_left = [&] { left = build(first, middle, depth + 1); };
        const auto build_right = [&] { right = build(middle, end, depth + 1); };
        if (end - first > kTaskTriangles) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
        slots_[middle - 1] = {left.box.min(),  left.reference,
                              left.box.max(),  right.reference,
                              right.box.min(), 0,
                              right.box.max(), 0};
        left.box.extend(right.box);
        return {left.box, static_cast<uint>(middle - 1), left.inner_count + right.inner_count + 1,
                std::max(left.depth, right.depth)};
    }

    std::span<Reference> references_;
    std::span<BvhNode> slots_;
    BvhConfig config_;
    std::size_t leaf_size_;
};

}  // namespace

SahTree build_sah_tree(const Scene& scene, std::span<const uint> ids, const BvhConfig& config) {
    if (ids.size() > NEARLIGHT_LEAF_FIRST_MASK) {
        throw Error(ExitCode::out_of_memory,
                    "scene has " + std::to_string(ids.size()) + " triangles, a tree holds " +
                        std::to_string(NEARLIGHT_LEAF_FIRST_MASK) + ": simplify the scene");
    }
    std::vector<Reference> references(ids.size());
    parallel_for(ids.size(), kLoopGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            references[i] = make_reference(scene, ids[i]);
        }
    });
    SahTree tree;
    tree.slots.resize(ids.size() - 1);
    const Subtree root = SahBuilder(references, tree.slots, config).build(0, ids.size(), 0);
    tree.root = root.reference;
    tree.root_box = {root.box.min(), root.box.max()};
    tree.inner_count = root.inner_count;
    tree.depth = root.depth;
    tree.order.reserve(ids.size());
    for (const Reference& reference : references) {
        tree.order.push_back(reference.id());
    }
    return tree;
}

}  // namespace nearlight
