// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/object_split.h"

#include <algorithm>
#include <array>

namespace nearlight {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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
            Bin& bin = bins[axis][mapping.bin(center[axis], axis)];
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

struct Plane {
    float cost = kInfinity;
    int axis = -1;
    int last_left_bin = 0;
};

/// The cheapest plane between bins of one axis, if it beats `best`.
Plane better_plane(const Bins& bins, int axis, Plane best) {
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

}  // namespace

ObjectSplit find_object_split(std::span<const Reference> range, const BinMapping& mapping) {
    const int bin_count = mapping.count();
    Bins bins(bin_count);
    fold(range, bins, [&](Bins& sum, const Reference& r) { sum.add(r, mapping); });
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
        best = better_plane(bins, axis, best);
    }
    ObjectSplit split;
    split.cost = best.cost;
    split.axis = best.axis;
    split.last_left_bin = best.last_left_bin;
    for (int i = 0; best.axis >= 0 && i < bin_count; ++i) {
        (i <= best.last_left_bin ? split.left : split.right).extend(bins.bins[best.axis][i].box);
    }
    return split;
}

std::size_t partition(std::span<Reference> range, const BinMapping& mapping, const ObjectSplit& split) {
    const auto right = std::partition(range.begin(), range.end(), [&](const Reference& reference) {
        alignas(16) float center[4];
        reference.get_center(center);
        return mapping.bin(center[split.axis], split.axis) <= split.last_left_bin;
    });
    return static_cast<std::size_t>(right - range.begin());
}

void split_in_halves(std::span<Reference> range, const RangeBounds& bounds) {
    const int axis = bounds.centers.longest_axis();
    const auto key = [axis](const Reference& r) { return 0.5f * r.low[axis] + 0.5f * r.high[axis]; };
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>((range.size() + 1) / 2),
                     range.end(), [&](const Reference& a, const Reference& b) {
                         return key(a) != key(b) ? key(a) < key(b) : a.id() < b.id();
                     });
}

}  // namespace nearlight
