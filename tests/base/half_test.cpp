// SPDX-License-Identifier: Apache-2.0
#include "host/base/half.h"

#include <gtest/gtest.h>

#include <limits>

namespace nearlight::core {
namespace {

TEST(Half, KnownValues) {
    EXPECT_EQ(half_to_float(0x0000u), 0.0f);
    EXPECT_EQ(half_to_float(0x3c00u), 1.0f);
    EXPECT_EQ(half_to_float(0xc000u), -2.0f);
    EXPECT_EQ(half_to_float(0x7bffu), 65504.0f);
    EXPECT_EQ(half_to_float(0x0001u), 0x1p-24f);
    EXPECT_EQ(half_to_float(0x03ffu), 1023 * 0x1p-24f);
    EXPECT_EQ(half_to_float(0x7c00u), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(half_to_float(0x7e00u)));
}

TEST(Half, EveryFiniteHalfComesBack) {
    for (std::uint32_t code = 0; code < 0x10000u; ++code) {
        const auto half = static_cast<std::uint16_t>(code);
        if ((code & 0x7c00u) != 0x7c00u) {
            ASSERT_EQ(float_to_half(half_to_float(half)), half) << code;
        }
    }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
    for (std::uint32_t code = 0; code < 0x7bffu; ++code) {
        const float low = half_to_float(static_cast<std::uint16_t>(code));
        const float high = half_to_float(static_cast<std::uint16_t>(code + 1));
        const float middle = 0.5f * (low + high);  // exact in a float
        ASSERT_EQ(float_to_half(middle), code + (code & 1u)) << code;
        ASSERT_EQ(float_to_half(std::nextafter(middle, low)), code) << code;
        ASSERT_EQ(float_to_half(std::nextafter(middle, high)), code + 1) << code;
    }
}

TEST(Half, EndsAtTheLargestHalf) {
    EXPECT_EQ(float_to_half(65519.0f), 0x7bffu);
    EXPECT_EQ(float_to_half(1e30f), 0x7bffu);
    EXPECT_EQ(float_to_half(-1e30f), 0xfbffu);
    EXPECT_EQ(float_to_half(std::numeric_limits<float>::infinity()), 0x7bffu);
}

}  // namespace
}  // namespace nearlight::core
