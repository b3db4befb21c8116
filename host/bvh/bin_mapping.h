// SPDX-License-Identifier: Apache-2.0
// Bins of equal thickness along each axis of a box, for finding where to split it.
#pragma once

#include "host/bvh/box4.h"

namespace nearlight {

class BinMapping {
  public:
    /// `count` bins an axis, one or more.
    BinMapping(const Box4& box, int count) : last_(static_cast<float>(count - 1)), count_(count) {
        for (int axis = 0; axis < 3; ++axis) {
            const float size = box.high[axis] - box.low[axis];
            low_[axis] = box.low[axis];
            thickness_[axis] = size / static_cast<float>(count);
            scale_[axis] = size > 0.0f ? static_cast<float>(count) / size : 0.0f;
        }
    }

    [[nodiscard]] int count() const { return count_; }
    /// Of a coordinate. Everything lies in bin 0 where the box has no thickness or an infinite one, and so
    /// does not-a-number.
    [[nodiscard]] int bin(float x, int axis) const {
        const float scaled = (x - low_[axis]) * scale_[axis];
        return scaled > 0.0f ? static_cast<int>(scaled < last_ ? scaled : last_) : 0;
    }
    /// The plane between bins `bin` − 1 and `bin`.
    [[nodiscard]] float plane(int bin, int axis) const {
        return low_[axis] + static_cast<float>(bin) * thickness_[axis];
    }

  private:
    float low_[3];
    float thickness_[3];
    float scale_[3];
    float last_;
    int count_;
};

}  // namespace nearlight
