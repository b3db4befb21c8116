// SPDX-License-Identifier: Apache-2.0
// Boxes with four lanes, so that one vector instruction handles a corner. The fourth lane is free for other
// data.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <limits>

#include "host/base/math.h"

namespace nearlight::core {

/// A box as plain data, so that arrays of boxes cost nothing until they are used. Start from empty().
struct alignas(16) Box4 {
    float low[4];
    float high[4];

    static constexpr Box4 empty() {
        return {{kInfinity, kInfinity, kInfinity, kInfinity},
                {-kInfinity, -kInfinity, -kInfinity, -kInfinity}};
    }

    void extend(const Box4& b) { extend(b.low, b.high); }
    void extend(const float* point) { extend(point, point); }  ///< four floats, aligned to 16 bytes
    /// Extends the box by the point a + t·(b − a). `a` and `b` are four floats each, aligned to 16 bytes.
    void extend_between(const float* a, const float* b, float t) {
        alignas(16) float point[4];
#ifdef __SSE2__
        const __m128 start = _mm_load_ps(a);
        _mm_store_ps(point, _mm_add_ps(start, _mm_mul_ps(_mm_set1_ps(t), _mm_sub_ps(_mm_load_ps(b), start))));
#else
        for (int i = 0; i < 4; ++i) {
            point[i] = a[i] + t * (b[i] - a[i]);
        }
#endif
        extend(point, point);
    }
    /// Reduces the box to what it has in common with b.
    void clip(const Box4& b) {
#ifdef __SSE2__
        _mm_store_ps(low, _mm_max_ps(_mm_load_ps(b.low), _mm_load_ps(low)));
        _mm_store_ps(high, _mm_min_ps(_mm_load_ps(b.high), _mm_load_ps(high)));
#else
        for (int i = 0; i < 4; ++i) {
            low[i] = b.low[i] > low[i] ? b.low[i] : low[i];
            high[i] = b.high[i] < high[i] ? b.high[i] : high[i];
        }
#endif
    }
    /// Extends the box by the centre of b. Its corners are halved before the sum, which could overflow.
    void extend_by_center(const Box4& b) {
        alignas(16) float center[4];
        b.get_center(center);
        extend(center, center);
    }
    /// Gets the centre, by the same arithmetic with and without SSE2. `center` is aligned to 16 bytes; its
    /// fourth lane means nothing.
    void get_center(float* center) const {
#ifdef __SSE2__
        const __m128 half = _mm_set1_ps(0.5f);
        _mm_store_ps(center, _mm_add_ps(_mm_mul_ps(half, without_fourth(_mm_load_ps(low))),
                                        _mm_mul_ps(half, without_fourth(_mm_load_ps(high)))));
#else
        for (int i = 0; i < 4; ++i) {
            center[i] = 0.5f * low[i] + 0.5f * high[i];
        }
#endif
    }
    /// Half the surface area, by the same arithmetic with and without SSE2.
    [[nodiscard]] float half_area() const {
#ifdef __SSE2__
        const __m128 size = without_fourth(_mm_sub_ps(_mm_load_ps(high), _mm_load_ps(low)));
        const __m128 products = _mm_mul_ps(size, _mm_shuffle_ps(size, size, _MM_SHUFFLE(3, 0, 2, 1)));
        const __m128 two = _mm_add_ss(products, _mm_shuffle_ps(products, products, _MM_SHUFFLE(3, 3, 3, 1)));
        return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehl_ps(products, products)));
#else
        const float x = high[0] - low[0];
        const float y = high[1] - low[1];
        const float z = high[2] - low[2];
        return x * y + y * z + z * x;
#endif
    }
    [[nodiscard]] int longest_axis() const {
        const float x = high[0] - low[0];
        const float y = high[1] - low[1];
        const float z = high[2] - low[2];
        return x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    }
    [[nodiscard]] Vec3 min() const {
        return {low[0], low[1], low[2]};
    }
    [[nodiscard]] Vec3 max() const {
        return {high[0], high[1], high[2]};
    }

  private:
#ifdef __SSE2__
    /// Clears the fourth lane: other data there may look like a denormal number, with which arithmetic is
    /// slow.
    static __m128 without_fourth(__m128 lanes) {
        return _mm_and_ps(lanes, _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1)));
    }
#endif
    void extend(const float* other_low, const float* other_high) {
#ifdef __SSE2__
        _mm_store_ps(low, _mm_min_ps(_mm_load_ps(other_low), _mm_load_ps(low)));
        _mm_store_ps(high, _mm_max_ps(_mm_load_ps(other_high), _mm_load_ps(high)));
#else
        for (int i = 0; i < 4; ++i) {
            low[i] = other_low[i] < low[i] ? other_low[i] : low[i];
            high[i] = other_high[i] > high[i] ? other_high[i] : high[i];
        }
#endif
    }
};

}  // namespace nearlight::core
