// SPDX-License-Identifier: Apache-2.0
// Splits references by a plane that cuts the references it meets in two [Stich, Friedrich and Dietrich,
// Spatial Splits in Bounding Volume Hierarchies, 2009].
#pragma once

#include <limits>
#include <span>

#include "host/bvh/bin_mapping.h"
#include "host/bvh/reference.h"

namespace nearlight::core {

constexpr int kMinSlabs = 4;
constexpr int kMaxSlabs = 16;

struct SpatialSplit {
    float cost = std::numeric_limits<float>::infinity();  ///< Σ half area · references of both sides
    int axis = -1;
    int first_right_slab = 0;
    uint left_count = 0;  ///< references that reach into the left side; cut ones reach into both
    uint right_count = 0;
    Box4 left = Box4::empty();
    Box4 right = Box4::empty();
};

class SpatialSplitter {
  public:
    /// `root` is the box of the whole tree. Cut parts overlap at the plane by more than a ray caster's
    /// rounding errors anywhere in `root`, so that no ray slips through between the two boxes of one
    /// triangle.
    SpatialSplitter(const Scene& scene, const Box4& root);

    /// False if squares of the extent leave the range of floats; nothing may be split then.
    [[nodiscard]] bool usable() const { return usable_; }

    /// Half area of the root's box.
    [[nodiscard]] float root_area() const { return root_area_; }

    /// How much splitting a reference of a whole triangle gains, in fixed point: the square root of the area
    /// by which its box exceeds the minimum box of a triangle with the same projections.
    [[nodiscard]] uint weight(const Reference& reference) const;

    /// Finds the cheapest plane between bins; none (axis −1) if it costs more than `max_cost`, or if it would
    /// in a sample of the references. `mapping` is that of the range's box, with a count in [kMinSlabs,
    /// kMaxSlabs].
    [[nodiscard]] SpatialSplit find(std::span<const Reference> range, const BinMapping& mapping,
                                    float max_cost) const;

    struct Parts {
        std::size_t left_count;
        std::size_t right_count;  ///< right references, which follow the left ones
    };
    /// Splits the first `count` references of `room`; behind them must be room for as many as the plane cuts.
    /// A reference that costs less whole goes to one side only (the paper's reference unsplitting). If one
    /// side stays empty, only the order has changed.
    Parts partition(std::span<Reference> room, std::size_t count, const BinMapping& mapping,
                    const SpatialSplit& split) const;

    struct Cut {
        Reference left;
        Reference right;
    };
    /// Cuts the part of the triangle that lies within the reference's box, by a plane through that box.
    [[nodiscard]] Cut cut(const Reference& reference, int axis, float position) const;

  private:
    const Scene& scene_;
    float root_area_;
    float pad_;
    bool usable_;
};

}  // namespace nearlight::core
