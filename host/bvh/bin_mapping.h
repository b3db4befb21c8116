// SPDX-License-Identifier: Apache-2.0
// Bins of equal thickness along each axis of a box, for finding where to split it.
#pragma once

#include "host/bvh/box4.h"

namespace nearlight::core {

class BinMapping {
  public:
    /// Divides each axis of `box` into `count` ≥ 1 bins.
    BinMapping(const Box4& box, int count)
        : low_{}, thickness_{}, scale_{}, last_(static_cast<float>(count - 1)), count_(count) {
        for (int axis = 0; axis < 3; ++axis) {
            const float size = box.high[axis] - box.low[axis];
            low_[axis] = box.low[axis];
            thickness_[axis] = size / static_cast<float>(count);
            scale_[axis] = size > 0.0f ? static_cast<float>(count) / size : 0.0f;
        }
    }

    [[nodiscard]] int count() const { return count_; }
    /// The bin of a coordinate. It is 0 for not-a-number, and for everything if the box has no thickness or
    /// an infinite one.
    [[nodiscard]] int bin(float x, int axis) const {
        const float scaled = (x - low_[axis]) * scale_[axis];
        return scaled > 0.0f ? static_cast<int>(scaled < last_ ? scaled : last_) : 0;
    }
    /// Gets the bins of a point's coordinates. `point` and `bins` have four elements, aligned to 16 bytes;
    /// the fourth one means nothing.
    void get_bins(const float* point, int* bins) const {
#ifdef __SSE2__
        const __m128 scaled =
            _mm_mul_ps(_mm_sub_ps(_mm_load_ps(point), _mm_load_ps(low_)), _mm_load_ps(scale_));
        // The maximum of not-a-number and 0 is its second operand.
        const __m128 clamped = _mm_min_ps(_mm_max_ps(scaled, _mm_setzero_ps()), _mm_set1_ps(last_));
        _mm_store_si128(reinterpret_cast<__m128i*>(bins), _mm_cvttps_epi32(clamped));
#else
        for (int axis = 0; axis < 3; ++axis) {
            bins[axis] = bin(point[axis], axis);
        }
#endif
    }
    /// Whether the bin of a coordinate is below `bin`, which is not the first; true for not-a-number.
    [[nodiscard]] bool is_before(int bin, float x, int axis) const {
        return !((x - low_[axis]) * scale_[axis] >= static_cast<float>(bin));
    }
    /// The coordinate of the plane between bins `bin` − 1 and `bin`.
    [[nodiscard]] float plane(int bin, int axis) const {
        return low_[axis] + static_cast<float>(bin) * thickness_[axis];
    }

  private:
    alignas(16) float low_[4];
    float thickness_[4];
    alignas(16) float scale_[4];
    float last_;
    int count_;
};

}  // namespace nearlight::core
