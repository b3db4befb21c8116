// SPDX-License-Identifier: Apache-2.0
// Texts that must be the same in every locale, because they are keys, or names that files and users write.
#include <gtest/gtest.h>

#include <clocale>
#include <limits>

#include "host/base/files.h"
#include "host/base/short_text.h"
#include "host/base/words.h"

namespace nearlight::core {
namespace {

// What is known when this is compiled follows no locale.
static_assert(lower_case('A') == 'a' && lower_case('Z') == 'z' && lower_case('m') == 'm');
static_assert(lower_case('@') == '@' && lower_case('[') == '[' && lower_case('\xc4') == '\xc4');

void expect_texts() {
    EXPECT_EQ(short_text(0.25f), "0.25");
    EXPECT_EQ(short_text(1500.0f), "1.5e+03");
    EXPECT_EQ(short_text(-2.0f), "-2");
    EXPECT_EQ(exact_text(1.0), "0x1p+0");
    EXPECT_EQ(exact_text(0.1), "0x1.999999999999ap-4");
    EXPECT_EQ(exact_text(-1.5), "-0x1.8p+0");
    EXPECT_EQ(exact_text(0.0), "0x0p+0");
    EXPECT_EQ(exact_text(std::numeric_limits<double>::infinity()), "inf");
    EXPECT_EQ(lower_case(std::string("Room.EXR \xc4")), "room.exr \xc4");
}

TEST(Texts, AreThoseOfTheLanguageC) {
    expect_texts();
}

TEST(Texts, FollowNoLocale) {
    const char* const kWithCommas[] = {"de_DE.UTF-8", "de_DE.ISO-8859-1", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    for (const char* const name : kWithCommas) {
        if (std::setlocale(LC_ALL, name) != nullptr) {
            expect_texts();
            std::setlocale(LC_ALL, "C");
            return;
        }
    }
    GTEST_SKIP() << "no locale that writes decimal commas is installed";
}

}  // namespace
}  // namespace nearlight::core
