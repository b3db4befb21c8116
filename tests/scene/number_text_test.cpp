// SPDX-License-Identifier: Apache-2.0
#include "host/scene/number_text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/image/color.h"

namespace nearlight::core {
namespace {

TEST(NumberText, NumbersAreTheWholeText) {
    EXPECT_EQ(number_in("1.5"), 1.5);
    EXPECT_EQ(number_in(" +2e3\n"), 2000.0);
    EXPECT_EQ(number_in("-0.25"), -0.25);
    EXPECT_EQ(number_in("1e-999"), 0.0);
    EXPECT_EQ(number_in("1e999"), HUGE_VAL);
    EXPECT_EQ(number_in("-1e999"), -HUGE_VAL);
    EXPECT_EQ(number_in("0." + std::string(330, '0') + "1"), 0.0);
    EXPECT_EQ(number_in("-" + std::string(330, '9')), -HUGE_VAL);
    EXPECT_EQ(number_in(std::string(400, '9') + "e-9"), HUGE_VAL);
    EXPECT_EQ(number_in("inf"), HUGE_VAL);
    EXPECT_TRUE(std::isnan(number_in("nan").value_or(0)));
    for (const char* text : {"", " ", "+", "++5", "+-5", "-+5", "+ 5", "1x", "x1", "1 2", "1,2", "0x10"}) {
        EXPECT_FALSE(number_in(text)) << text;
    }
}

TEST(NumberText, CommasSeparateNumbers) {
    EXPECT_EQ(numbers_in("1"), std::vector{1.0});
    EXPECT_EQ(numbers_in("1, -2,3e1"), (std::vector{1.0, -2.0, 30.0}));
    for (const char* text : {"", ",", "1,", ",1", "1,,2", "1 2", "1,x"}) {
        EXPECT_FALSE(numbers_in(text)) << text;
    }
}

TEST(NumberText, ColoursHaveSixDigits) {
    const Vec3 color = hex_color_in("#ff8001").value();
    EXPECT_EQ(color.x, 1.0f);
    EXPECT_NEAR(color.y, srgb_to_linear(128 / 255.0f), 1e-6f);
    EXPECT_NEAR(color.z, srgb_to_linear(1 / 255.0f), 1e-6f);
    for (const char* text : {"", "#", "#ff800", "#ff80011", "ff80011", "#ff80g1", "#-f8001", " #ff8001"}) {
        EXPECT_FALSE(hex_color_in(text)) << text;
    }
}

}  // namespace
}  // namespace nearlight::core
