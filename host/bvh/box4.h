// SPDX-License-Identifier: Apache-2.0
// Boxes of four lanes, which compilers turn into vector instructions. The fourth lane is free.
#pragma once

#include <limits>

#include "host/base/math.h"

namespace nearlight {

/// Plain data, so that arrays of it cost nothing until used: start from empty().
struct alignas(16) Box4 {
    float low[4];
    float high[4];

    static constexpr Box4 empty() {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        return {{kInfinity, kInfinity, kInfinity, kInfinity},
                {-kInfinity, -kInfinity, -kInfinity, -kInfinity}};
    }

    void extend(const Box4& b) {
        for (int i = 0; i < 4; ++i) {
            low[i] = b.low[i] < low[i] ? b.low[i] : low[i];
        }
        for (int i = 0; i < 4; ++i) {
            high[i] = b.high[i] > high[i] ? b.high[i] : high[i];
        }
    }
    /// By the middle of b; halved before the sum, which could overflow.
    void extend_by_center(const Box4& b) {
        for (int i = 0; i < 4; ++i) {
            const float c = 0.5f * b.low[i] + 0.5f * b.high[i];
            low[i] = c < low[i] ? c : low[i];
            high[i] = c > high[i] ? c : high[i];
        }
    }
    [[nodiscard]] float half_area() const {
        const float x = high[0] - low[0];
        const float y = high[1] - low[1];
        const float z = high[2] - low[2];
        return x * y + y * z + z * x;
    }
    [[nodiscard]] int longest_axis() const {
        const float x = high[0] - low[0];
        const float y = high[1] - low[1];
        const float z = high[2] - low[2];
        return x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    }
    [[nodiscard]] Vec3 min() const { return {low[0], low[1], low[2]}; }
    [[nodiscard]] Vec3 max() const { return {high[0], high[1], high[2]}; }
};

}  // namespace nearlight
