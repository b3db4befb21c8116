// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/image/image_io.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

class VplOptions : public testing::Test {
  protected:
    VplOptions() { std::ofstream(folder_ / "scene.xml") << floor_and_wall(""); }
    [[nodiscard]] ProgramResult render(const std::string& options) const {
        return run_program("render --json --spp 2 --size 32x24 " + options + " " +
                           quoted(folder_ / "scene.xml") + " -o " + quoted(folder_ / "a.exr"));
    }
    void expect_refusal(const std::string& options, int exit_code, const std::string& part) const {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exit_code, exit_code) << result.errors;
        EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    }

    TemporaryFolder folder_;
    std::string file_ = quoted(folder_ / "vpls.ply");
};

TEST_F(VplOptions, VplsGoThroughAFile) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult first = render("--vpls 100 --save-vpls " + file_);
    ASSERT_EQ(first.exit_code, 0) << first.errors;
    const ProgramResult second = render("--load-vpls " + file_);
    ASSERT_EQ(second.exit_code, 0) << second.errors;
    const nlohmann::json json = nlohmann::json::parse(second.output);
    EXPECT_EQ(json["image_hash"], nlohmann::json::parse(first.output)["image_hash"]);
    EXPECT_EQ(json["sampler"], "file");
    EXPECT_EQ(std::get<std::string>(read_metadata(folder_ / "a.exr").at("nearlight:sampler")), "file");
    EXPECT_EQ(render("--origin 0,1,4 --target 0,0,0 --load-vpls " + file_).exit_code, 0);
    expect_refusal("--light-scale 2 --load-vpls " + file_, 3, "another scene");
}

TEST_F(VplOptions, AFileSaysItselfWhatAPixelAsks) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult first = render("--vpls 100 --cuts on --save-vpls " + file_);
    ASSERT_EQ(first.exit_code, 0) << first.errors;
    const nlohmann::json saved = nlohmann::json::parse(first.output);
    const ProgramResult second = render("--load-vpls " + file_);
    ASSERT_EQ(second.exit_code, 0) << second.errors;
    const nlohmann::json loaded = nlohmann::json::parse(second.output);
    EXPECT_EQ(loaded["image_hash"], saved["image_hash"]);
    EXPECT_EQ(loaded["cuts"], true);
    EXPECT_EQ(loaded["vpls"]["requested"], nullptr);
    EXPECT_EQ(loaded["vpls"]["set"], saved["vpls"]["close"].get<int>() + saved["vpls"]["distant"].get<int>());
    EXPECT_EQ(loaded["close_fraction"], saved["close_fraction"]);
    EXPECT_EQ(read_metadata(folder_ / "a.exr").at("nearlight:vplsAsked"), Metadata::mapped_type{100});
}

TEST_F(VplOptions, WhatMakesNoSenseIsRefused) {
    NEARLIGHT_NEEDS_DEVICE();
    expect_refusal("--passes 2 --save-vpls " + file_, 2, "--save-vpls needs a picture of one pass");
    expect_refusal("--time 10 --save-vpls " + file_, 2, "--save-vpls needs a picture of one pass");
    expect_refusal("--load-vpls " + file_, 3, "no such file");
    expect_refusal("--vpls 50 --load-vpls " + file_, 2, "--vpls");
    expect_refusal("--save-vpls " + quoted(folder_ / "nosuch" / "a.ply"), 3, "nosuch");
    expect_refusal("-o a.png --save-vpls ./a.png", 2, "--save-vpls './a.png' is the picture's file too");
}

}  // namespace
}  // namespace nearlight::core
