// SPDX-License-Identifier: Apache-2.0
#include "host/cli/frame_options.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/image/temporary_folder.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(FrameOptions, RangesHaveBothEnds) {
    const FrameRange range = parse_frames("8:12");
    EXPECT_EQ(range.first, 8);
    EXPECT_EQ(range.last, 12);
    EXPECT_EQ(parse_frames("7").first, 7);
    EXPECT_EQ(parse_frames("7").last, 7);
    EXPECT_EQ(parse_frames("0:999999").last, 999999);
}

TEST(FrameOptions, OtherRangesAreRefused) {
    for (const char* text : {"", ":", "1:", ":2", "a:b", "1:2:3", "-1:2", "1-2", "1.5:3", "1: 2", "0:1000000",
                             "99999999999999999999", "1,2"}) {
        const Error error = test::error_of([&] { parse_frames(text); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
        EXPECT_TRUE(test::mentions(error, std::string("not '") + text + "'"));
    }
    EXPECT_TRUE(
        test::mentions(test::error_of([] { parse_frames("9:3"); }), "ends before it begins; give 3:9"));
}

TEST(FrameOptions, NumbersHaveTheirPlaceInNames) {
    for (const auto& [file, name] : {std::pair{"walk.exr", "walk.0007.exr"},
                                     {"walk.####.exr", "walk.0007.exr"},
                                     {"##/walk_#.png", "##/walk_7.png"},
                                     {"a#b##.exr", "a#b07.exr"},
                                     {"dir.x/walk", "dir.x/walk.0007"},
                                     {"######", "000007"}}) {
        EXPECT_EQ(numbered(file, 7), name);
    }
    EXPECT_EQ(numbered("w.##.exr", 1234), "w.1234.exr");
    EXPECT_THAT(numbered(std::vector<std::string>{"a.exr", "#.png"}, 12),
                ElementsAre("a.0012.exr", "12.png"));
}

TEST(FrameOptions, FramesOfWhichAllFilesAreThereMayBeSkipped) {
    const TemporaryFolder folder;
    const std::vector<std::string> outputs{(folder / "a.exr").string(), (folder / "b.##.png").string()};
    FrameOptions options{.range = FrameRange{3, 6}};
    for (const char* name : {"a.0004.exr", "a.0005.exr", "b.05.png"}) {
        std::ofstream(folder / name) << "picture";
    }
    EXPECT_THAT(frames_to_make(options, outputs), ElementsAre(3, 4, 5, 6));
    options.skip_existing = true;
    EXPECT_THAT(frames_to_make(options, outputs), ElementsAre(3, 4, 6));
    options.range = FrameRange{5, 5};
    EXPECT_THAT(frames_to_make(options, outputs), IsEmpty());
}

}  // namespace
}  // namespace nearlight::core
