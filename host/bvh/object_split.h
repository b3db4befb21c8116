// SPDX-License-Identifier: Apache-2.0
// Where to part references into two sets: binned surface area heuristic [Wald, On fast Construction of
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

/// A plane between bins of one axis; of up to kTriedInFull references any set on the left.
struct ObjectSplit {
    float cost = std::numeric_limits<float>::infinity();  ///< Σ half area · references of both sides
    int axis = -1;
    int last_left_bin = 0;
    uint left_set = 0;  ///< bit i: the i-th is on the left; 0: a plane decides
    [[nodiscard]] bool found() const { return axis >= 0 || left_set != 0; }
    Box4 left = Box4::empty();
    Box4 right = Box4::empty();
};

/// The cheapest one. `mapping` is of the references' centres, its count in [kMinBins, kMaxBins].
ObjectSplit find_object_split(std::span<const Reference> range, const BinMapping& mapping);

/// Moves those left of the plane to the front, and returns how many they are.
std::size_t partition(std::span<Reference> range, const BinMapping& mapping, const ObjectSplit& split);

/// Puts the lower half along the longest axis of the centres first: (size + 1) / 2 references.
void split_in_halves(std::span<Reference> range, const RangeBounds& bounds);

}  // namespace nearlight::core
