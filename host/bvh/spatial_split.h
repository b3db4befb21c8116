// SPDX-License-Identifier: Apache-2.0
// Parting references by a plane that cuts those it meets in two [Stich, Friedrich and Dietrich, Spatial
// Splits in Bounding Volume Hierarchies, 2009].
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
    uint left_count = 0;  ///< references that reach into each side; some into both
    uint right_count = 0;
    Box4 left = Box4::empty();
    Box4 right = Box4::empty();
};

class SpatialSplitter {
  public:
    /// `root` is the box of all. Parts overlap at the plane by more than a ray caster's rounding errors
    /// anywhere in it, so that no ray slips through between the two boxes of one triangle.
    SpatialSplitter(const Scene& scene, const Box4& root);

    /// False where squares of the extent leave the range of floats: nothing is to be split then.
    [[nodiscard]] bool usable() const { return usable_; }

    /// Half area of the root's box.
    [[nodiscard]] float root_area() const { return root_area_; }

    /// How much is to be gained by splitting a reference of a whole triangle, in fixed point: the root of the
    /// area that its box has beyond the least box of a triangle of such projections.
    [[nodiscard]] uint weight(const Reference& reference) const;

    /// The cheapest plane between bins; none (axis −1) where it costs more than `max_cost`, or where a
    /// sample of the references says so. `mapping` is of the range's box, its count in [kMinSlabs,
    /// kMaxSlabs].
    [[nodiscard]] SpatialSplit find(std::span<const Reference> range, const BinMapping& mapping,
                                    float max_cost) const;

    struct Parts {
        std::size_t left_count;
        std::size_t right_count;  ///< these follow
    };
    /// Parts the first `count` entries; behind them must be room for as many as the plane cuts. A reference
    /// that costs less whole goes to one side only (the paper's reference unsplitting). Where one side stays
    /// empty nothing has changed but the order.
    Parts partition(std::span<Reference> room, std::size_t count, const BinMapping& mapping,
                    const SpatialSplit& split) const;

    struct Cut {
        Reference left;
        Reference right;
    };
    /// The parts of the triangle within the reference's box on both sides of a plane through that.
    [[nodiscard]] Cut cut(const Reference& reference, int axis, float position) const;

  private:
    const Scene& scene_;
    float root_area_;
    float pad_;
    bool usable_;
};

}  // namespace nearlight::core
