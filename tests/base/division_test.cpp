// SPDX-License-Identifier: Apache-2.0
#include "host/base/division.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace nearlight::core {
namespace {

TEST(Division, RoundsUp) {
    for (unsigned count = 0; count < 40; ++count) {
        for (unsigned by = 1; by < 12; ++by) {
            unsigned parts = 0;
            while (parts * by < count) {
                ++parts;
            }
            EXPECT_EQ(divide_rounding_up(count, by), parts) << count << " / " << by;
            EXPECT_EQ(round_up_to_multiple(count, by), parts * by) << count << " / " << by;
        }
    }
}

TEST(Division, HasTheRangeOfTheWiderNumber) {
    constexpr std::uint64_t kCount = std::numeric_limits<std::uint32_t>::max() + std::uint64_t{2};
    EXPECT_EQ(divide_rounding_up(kCount, 1u), kCount);
    EXPECT_EQ(round_up_to_multiple(kCount, 64), kCount + 63);
}

}  // namespace
}  // namespace nearlight::core
