// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/object_split.h"

#include <algorithm>
#include <array>
#include <bit>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

struct Bins {
    explicit Bins(int count) : bin_count(count) {
        for (int axis = 0; axis < 3; ++axis) {
            std::fill_n(boxes[axis].begin(), count, Box4::empty());
            std::fill_n(counts[axis].begin(), count, 0u);
        }
    }
    void add(const Reference& reference, const BinMapping& mapping) {
        alignas(16) float center[4];
        alignas(16) int bins[4];
        reference.get_center(center);
        mapping.get_bins(center, bins);
        for (int axis = 0; axis < 3; ++axis) {
            boxes[axis][bins[axis]].extend(reference);
            ++counts[axis][bins[axis]];
        }
    }
    void add(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = 0; i < bin_count; ++i) {
                boxes[axis][i].extend(other.boxes[axis][i]);
                counts[axis][i] += other.counts[axis][i];
            }
        }
    }

    int bin_count;  // bins beyond the count are never touched
    std::array<std::array<Box4, kMaxBins>, 3> boxes;
    std::array<std::array<uint, kMaxBins>, 3> counts;
};

struct Plane {
    float cost = kInfinity;
    int axis = -1;
    int last_left_bin = 0;
};

/// The cheapest plane between bins of one axis if it beats `best`, otherwise `best`.
Plane better_plane(const Bins& bins, int axis, Plane best) {
    std::array<float, kMaxBins> right_cost;
    const auto& boxes = bins.boxes[axis];
    const auto& counts = bins.counts[axis];
    Box4 right = Box4::empty();
    uint right_count = 0;
    for (int i = bins.bin_count - 1; i > 0; --i) {
        right.extend(boxes[i]);
        right_count += counts[i];
        right_cost[i] = right_count > 0 ? right.half_area() * static_cast<float>(right_count) : kInfinity;
    }
    Box4 left = Box4::empty();
    uint left_count = 0;
    for (int i = 0; i + 1 < bins.bin_count; ++i) {
        left.extend(boxes[i]);
        left_count += counts[i];
        if (left_count == 0) {
            continue;
        }
        const float cost = left.half_area() * static_cast<float>(left_count) + right_cost[i + 1];
        if (cost < best.cost) {
            best = {cost, axis, i};
        }
    }
    return best;
}

/// Tries every set of a few references as the left side. The bits of a number name the set; the last
/// reference stays on the right.
ObjectSplit find_best_set(std::span<const Reference> range) {
    std::array<Box4, 1u << kTriedInFull> boxes;
    std::array<float, 1u << kTriedInFull> costs;
    std::array<float, 1u << kTriedInFull> sizes;
    const uint all = (1u << range.size()) - 1u;
    boxes[0] = Box4::empty();
    sizes[0] = 0.0f;
    for (uint set = 1; set <= all; ++set) {
        const uint without_first = set & (set - 1u);
        boxes[set] = boxes[without_first];
        boxes[set].extend(range[static_cast<std::size_t>(std::countr_zero(set))]);
        sizes[set] = sizes[without_first] + 1.0f;
        costs[set] = boxes[set].half_area() * sizes[set];
    }
    ObjectSplit split;
    for (uint set = 1; set <= all / 2; ++set) {
        const float cost = costs[set] + costs[all ^ set];
        if (cost < split.cost) {
            split.cost = cost;
            split.left_set = set;
        }
    }
    split.left = boxes[split.left_set];
    split.right = boxes[all ^ split.left_set];
    return split;
}

/// Moves the references of a set to the front, and returns their number.
std::size_t partition_by_set(std::span<Reference> range, uint left_set) {
    std::array<Reference, kTriedInFull> copies;
    std::copy(range.begin(), range.end(), copies.begin());
    std::size_t left = 0;
    std::size_t right = static_cast<std::size_t>(std::popcount(left_set));
    const std::size_t left_count = right;
    for (std::size_t i = 0; i < range.size(); ++i) {
        range[(left_set >> i & 1u) != 0 ? left++ : right++] = copies[i];
    }
    return left_count;
}

}  // namespace

ObjectSplit find_object_split(std::span<const Reference> range, const BinMapping& mapping) {
    if (range.size() <= kTriedInFull) {
        return find_best_set(range);
    }
    const int bin_count = mapping.count();
    Bins bins(bin_count);
    fold(range, bins, [&](Bins& sum, std::span<const Reference> part) {
        for (const Reference& reference : part) {
            sum.add(reference, mapping);
        }
    });
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
        best = better_plane(bins, axis, best);
    }
    ObjectSplit split;
    split.cost = best.cost;
    split.axis = best.axis;
    split.last_left_bin = best.last_left_bin;
    for (int i = 0; best.axis >= 0 && i < bin_count; ++i) {
        (i <= best.last_left_bin ? split.left : split.right).extend(bins.boxes[best.axis][i]);
    }
    return split;
}

std::size_t partition(std::span<Reference> range, const BinMapping& mapping, const ObjectSplit& split) {
    if (split.left_set != 0) {
        return partition_by_set(range, split.left_set);
    }
    // The loop has no branches, because the side of a reference is unpredictable. The right side so far
    // begins at `left`.
    std::size_t left = 0;
    for (Reference& place : range) {
        const Reference reference = place;
        const float center = 0.5f * reference.low[split.axis] + 0.5f * reference.high[split.axis];
        place = range[left];
        range[left] = reference;
        left += mapping.is_before(split.last_left_bin + 1, center, split.axis) ? 1u : 0u;
    }
    return left;
}

void split_in_halves(std::span<Reference> range, const RangeBounds& bounds) {
    const int axis = bounds.centers.longest_axis();
    const auto key = [axis](const Reference& r) { return 0.5f * r.low[axis] + 0.5f * r.high[axis]; };
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>((range.size() + 1) / 2),
                     range.end(), [&](const Reference& a, const Reference& b) {
                         return key(a) != key(b) ? key(a) < key(b) : a.id() < b.id();
                     });
}

}  // namespace nearlight::core
