// SPDX-License-Identifier: Apache-2.0
#include "host/base/printable.h"

#include <gtest/gtest.h>

namespace nearlight::core {
namespace {

TEST(Printable, LeavesTextAlone) {
    const std::string text = "a\tb\nµ 日本 😀 €~";
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(printable(""), "");
}

TEST(Printable, TakesOutWhatATerminalWouldObey) {
    EXPECT_EQ(printable("a\x1b[31mb\r\x07\x7f"), "a?[31mb???");
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "1m \xc2\xa0"),
              "?1m \xc2\xa0");
}

TEST(Printable, TakesOutWhatIsNotUtf8) {
    EXPECT_EQ(printable("caf\xe9.xml"), "caf?.xml");
    EXPECT_EQ(printable("\x9b"
                        "1m"),
              "?1m");
    EXPECT_EQ(printable("\xc3"), "?");
    EXPECT_EQ(printable("\xc0\xaf \xe0\x80\x80 \xed\xa0\x80 \xf4\x90\x80\x80 \xff"), "?? ??? ??? ???? ?");
}

TEST(Printable, LinesAreOneLineAndNotEndless) {
    EXPECT_EQ(printable_line("a\nb"), "a b");
    EXPECT_LT(printable_line(std::string(1'000'000, 'x')).size(), 6000u);
}

TEST(Printable, WhatIsNotUtf8IsLatin1) {
    for (const char* text : {"", "plain", "B\u00e4r", "日本 😀"}) {
        EXPECT_EQ(utf8_or_latin1(text), text);
    }
    EXPECT_EQ(utf8_or_latin1("B\xe4r"), "B\u00e4r");
    EXPECT_EQ(utf8_or_latin1("\u00e4 B\xfcr"), "\u00c3\u00a4 B\u00fcr");
    EXPECT_EQ(utf8_or_latin1("cut \xe6\x97"), "cut \u00e6\u0097");
}

}  // namespace
}  // namespace nearlight::core
