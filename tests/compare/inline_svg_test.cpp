// SPDX-License-Identifier: Apache-2.0
#include "host/compare/inline_svg.h"

#include <gtest/gtest.h>

namespace nearlight::core {
namespace {

TEST(InlineSvg, HasTheColoursOfThePageAndADescription) {
    const std::string file = R"(<?xml version="1.0" encoding="utf-8"  standalone="no"?>
<svg
 viewBox="0 0 820 440"
 xmlns="http://www.w3.org/2000/svg"
 xmlns:xlink="http://www.w3.org/1999/xlink"
>

<title>Gnuplot</title>
<desc>Produced by GNUPLOT 5.4 patchlevel 4 </desc>

<g id="gnuplot_canvas">
<rect x="0" y="0" width="820" height="440" fill="#ffffff"/>
<path stroke='black' d='M0,0'/><g fill="black"/><use xlink:href='#gpPt0'/><path stroke='rgb(  0,   0,   0)'/><path stroke='rgb(  0, 114, 178)'/>
</g></svg>
)";
    EXPECT_EQ(inline_svg(file, "a < b", "desk"), R"(<svg role="img" aria-label="a &lt; b"
 viewBox="0 0 820 440"
>

<g id="desk-gnuplot_canvas">
<rect x="0" y="0" width="820" height="440" fill="none"/>
<path stroke='currentColor' d='M0,0'/><g fill="currentColor"/><use xlink:href='#desk-gpPt0'/><path stroke='currentColor'/><path stroke='rgb(  0, 114, 178)'/>
</g></svg>
)");
}

TEST(InlineSvg, IsEmptyWhereThereIsNone) {
    EXPECT_EQ(inline_svg("", "", "a"), "");
    EXPECT_EQ(inline_svg("<html></html>", "x", "a"), "");
    EXPECT_EQ(inline_svg("<svg>", "x", "a"), "");
}

}  // namespace
}  // namespace nearlight::core
