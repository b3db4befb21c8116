// SPDX-License-Identifier: Apache-2.0
#include "host/cli/advice.h"

#include <gtest/gtest.h>

#include <regex>

#include "tests/cli/run_program.h"

namespace nearlight::core {
namespace {

TEST(Advice, NamesTheOptionOfASetting) {
    EXPECT_EQ(with_advice(Error(ErrorKind::kernel_build, "no kernel file 'film.cl'", "kernel_dir")),
              "no kernel file 'film.cl'; check --kernel-dir");
    EXPECT_EQ(with_advice(Error(ErrorKind::invalid_argument, "a depth of 2", "max_depth")),
              "a depth of 2; see --max-depth");
}

TEST(Advice, LessMemoryIsASmallerPicture) {
    EXPECT_EQ(with_advice(Error(ErrorKind::out_of_memory, "no room")),
              "no room; use a smaller --size, --spp or scene");
    EXPECT_EQ(with_advice(Error(ErrorKind::out_of_memory, "too many pixels", "size")),
              "too many pixels; use a smaller --size");
}

TEST(Advice, IsLeftOutWhereNoOptionHelps) {
    EXPECT_EQ(with_advice(Error(ErrorKind::file, "room.obj:2: broken")), "room.obj:2: broken");
}

/// Every option in the advice for any setting that the rooms name is in the help of a command.
TEST(Advice, OptionsExist) {
    const std::string help = run_program("render --help").output + run_program("compare --help").output +
                             run_program("bench gather --help").output;
    for (const char* setting :
         {"baseline", "cache_dir", "clamp_fraction", "crop", "device", "file", "interleave", "kernel_dir",
          "max_depth", "reference_files", "reference_sampler", "reference_vpls", "samplers", "segments",
          "size", "strict", "vpls"}) {
        const std::string advised = with_advice(Error(ErrorKind::invalid_argument, "", setting));
        std::smatch option;
        ASSERT_TRUE(std::regex_search(advised, option, std::regex("--[a-z-]+"))) << setting;
        EXPECT_NE(help.find(option.str()), std::string::npos) << option.str();
    }
}

}  // namespace
}  // namespace nearlight::core
