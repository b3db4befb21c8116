// SPDX-License-Identifier: Apache-2.0
// Splits references into two sets by the binned surface area heuristic [Wald, On fast Construction of
// SAH-based Bounding Volume Hierarchies, 2007].
#pragma once

#include <limits>
#include <span>

#include "host/bvh/bin_mapping.h"
#include "host/bvh/reference.h"

namespace nearlight::core {

constexpr int kMinBins = 4;
constexpr int kMaxBins = 64;

constexpr std::size_t kTriedInFull = 4;

/// A split of references: by a plane between bins of one axis, or by any set if they are kTriedInFull or
/// fewer.
struct ObjectSplit {
    float cost = std::numeric_limits<float>::infinity();  ///< Σ half area · references of both sides
    int axis = -1;
    int last_left_bin = 0;
    uint left_set = 0;  ///< bit i: reference i is on the left; 0: a plane decides
    [[nodiscard]] bool found() const { return axis >= 0 || left_set != 0; }
    Box4 left = Box4::empty();
    Box4 right = Box4::empty();
};

/// Finds the cheapest split. `mapping` is that of the references' centres, with a count in [kMinBins,
/// kMaxBins].
ObjectSplit find_object_split(std::span<const Reference> range, const BinMapping& mapping);

/// Moves the references of the left side to the front, and returns their number.
std::size_t partition(std::span<Reference> range, const BinMapping& mapping, const ObjectSplit& split);

/// Moves the lower half, (size + 1) / 2 references, to the front, by the longest axis of the centres.
void split_in_halves(std::span<Reference> range, const RangeBounds& bounds);

}  // namespace nearlight::core
