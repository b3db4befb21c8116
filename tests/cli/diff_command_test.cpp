// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/image/image_io.h"
#include "tests/cli/run_program.h"

namespace nearlight::core {
namespace {

Image constant_image(int width, int height, const std::vector<std::string>& channels, float value) {
    Image image = make_image(width, height, channels);
    std::fill(image.values.begin(), image.values.end(), value);
    return image;
}

class Diff : public testing::Test {
  protected:
    Diff() {
        write_image(a_, constant_image(20, 10, {"R", "G", "B", "direct.R", "direct.G", "direct.B", "extra.R"},
                                       0.75f));
        write_image(b_, constant_image(20, 10, {"R", "G", "B", "direct.R", "direct.G", "direct.B"}, 0.5f));
    }
    TemporaryFolder folder_;
    std::filesystem::path a_ = folder_ / "a.exr";
    std::filesystem::path b_ = folder_ / "b picture.exr";
    std::string both_ = quoted(a_) + " " + quoted(b_);
};

TEST_F(Diff, JsonHasTheFiguresOfEveryCommonLayer) {
    const ProgramResult result = run_program("diff --json " + both_);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["image"], a_.string());
    EXPECT_EQ(json["reference"], b_.string());
    EXPECT_EQ(json["width"], 20);
    EXPECT_EQ(json["height"], 10);
    ASSERT_EQ(json["layers"].size(), 2u);
    EXPECT_EQ(json["layers"][0]["layer"], "beauty");
    EXPECT_EQ(json["layers"][1]["layer"], "direct");
    for (const auto& layer : json["layers"]) {
        EXPECT_NEAR(layer["rmse"], 0.25, 1e-7);
        EXPECT_NEAR(layer["relative_mse"], 0.0625 / 0.26, 1e-6);
        EXPECT_NEAR(layer["mean_ratio"], 1.5, 1e-6);
        EXPECT_GT(layer["flip"], 0.05);
        EXPECT_LT(layer["flip"], 0.9);
        EXPECT_EQ(layer["non_finite"], 0);
    }
}

TEST_F(Diff, TableForPeople) {
    const ProgramResult result = run_program("diff " + both_);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find("RMSE"), std::string::npos);
    EXPECT_NE(result.output.find("\nbeauty "), std::string::npos) << "the name that --layer takes";
    EXPECT_NE(result.output.find("direct"), std::string::npos);
    EXPECT_NE(result.output.find("1.500000"), std::string::npos);
}

TEST_F(Diff, OneLayer) {
    const ProgramResult result = run_program("diff --json --layer direct " + both_);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json["layers"].size(), 1u);
    EXPECT_EQ(json["layers"][0]["layer"], "direct");
    const ProgramResult beauty = run_program("diff --json --layer beauty " + both_);
    ASSERT_EQ(beauty.exit_code, 0) << beauty.errors;
    EXPECT_EQ(nlohmann::json::parse(beauty.output)["layers"][0]["layer"], "beauty");
    const ProgramResult missing = run_program("diff --json --layer extra " + both_);
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_EQ(missing.output, "");
    EXPECT_NE(missing.errors.find("b picture.exr' has no layer 'extra'; it has beauty, direct\n"),
              std::string::npos)
        << missing.errors;
    const ProgramResult unknown = run_program("diff --layer foo " + both_);
    EXPECT_NE(unknown.errors.find("a.exr' has no layer 'foo'; it has beauty, direct, extra"),
              std::string::npos)
        << unknown.errors;
}

TEST_F(Diff, LayersOfOtherChannelsHaveNoFlip) {
    write_image(folder_ / "near.exr", constant_image(8, 4, {"depth.Z"}, 2.0f));
    write_image(folder_ / "far.exr", constant_image(8, 4, {"depth.Z"}, 4.0f));
    const std::string files = quoted(folder_ / "near.exr") + " " + quoted(folder_ / "far.exr");
    const ProgramResult result = run_program("diff --json --layer depth " + files);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json layer = nlohmann::json::parse(result.output)["layers"][0];
    EXPECT_NEAR(layer["rmse"], 2.0, 1e-6);
    EXPECT_NEAR(layer["mean_ratio"], 0.5, 1e-6);
    EXPECT_TRUE(layer["flip"].is_null());
    EXPECT_NE(run_program("diff --layer depth " + files).output.find("–"), std::string::npos);
}

TEST_F(Diff, WritesTheMapAndKeepsOutputPure) {
    const auto map = folder_ / "map.png";
    const ProgramResult result = run_program("diff --json --verbose " + both_ + " -o " + quoted(map));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(nlohmann::json::accept(result.output)) << result.output;
    EXPECT_NE(result.errors.find("map.png"), std::string::npos);
    const Image image = read_image(map);
    EXPECT_EQ(image.width, 20);
    EXPECT_EQ(image.height, 10);
    EXPECT_EQ(run_program("diff --json --quiet " + both_ + " -o " + quoted(map)).errors, "");
}

TEST_F(Diff, PngIsDecodedBeforeItIsCompared) {
    write_image(folder_ / "a.png", read_image(a_));
    const ProgramResult result = run_program("diff --json " + quoted(folder_ / "a.png") + " " + quoted(a_));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NEAR(nlohmann::json::parse(result.output)["layers"][0]["mean_ratio"], 1.0, 0.01);
}

TEST_F(Diff, FilesThatCannotBeComparedAreErrors) {
    write_image(folder_ / "small.exr", constant_image(20, 9, {"R", "G", "B"}, 0.5f));
    write_image(folder_ / "depth.exr", constant_image(20, 10, {"depth.Z"}, 0.5f));
    for (const char* other : {"small.exr", "depth.exr", "none.exr"}) {
        const ProgramResult result = run_program("diff --json " + quoted(a_) + " " + quoted(folder_ / other));
        EXPECT_EQ(result.exit_code, 3) << other;
        EXPECT_EQ(result.output, "") << other;
        EXPECT_NE(result.errors.find(other), std::string::npos) << result.errors;
    }
}

TEST_F(Diff, AMapReplacesNoPictureThatItCompares) {
    const std::string before = file_text(b_);
    const ProgramResult result = run_program("diff " + both_ + " -o " + quoted(b_));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("would replace"), std::string::npos) << result.errors;
    EXPECT_EQ(file_text(b_), before);
}

/// A picture whose columns and rows differ.
Image ramp(int width, int height) {
    Image image = make_image(width, height, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = static_cast<float>(i) / 1000.0f;
    }
    return image;
}

TEST_F(Diff, APartIsComparedWithItsPartOfTheWhole) {
    const Image whole = ramp(20, 10);
    const ImagePlace place{.x = 3, .y = 2, .whole_width = 20, .whole_height = 10};
    write_image(folder_ / "whole.exr", whole);
    write_image(folder_ / "part.exr", part_of(whole, place.x, place.y, 6, 5), {.place = place});
    const std::string part = quoted(folder_ / "part.exr") + " ";
    const std::string all = quoted(folder_ / "whole.exr") + " ";
    for (const std::string& files : {part + all, all + part}) {
        const ProgramResult result = run_program("diff --json " + files);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
        const nlohmann::json json = nlohmann::json::parse(result.output);
        EXPECT_EQ(json["width"], 6);
        EXPECT_EQ(json["layers"][0]["rmse"], 0.0);
    }
    write_image(folder_ / "part.png", part_of(whole, place.x, place.y, 6, 5));
    const ProgramResult without_place = run_program("diff " + part + quoted(folder_ / "part.png"));
    EXPECT_EQ(without_place.exit_code, 0) << without_place.errors;
}

TEST_F(Diff, DifferentPartsAreNotCompared) {
    const Image whole = ramp(20, 10);
    for (const int x : {0, 10}) {
        const ImagePlace place{.x = x, .y = 0, .whole_width = 20, .whole_height = 10};
        write_image(folder_ / fmt::format("{}.exr", x), part_of(whole, place.x, place.y, 10, 10),
                    {.place = place});
    }
    const ProgramResult result =
        run_program("diff " + quoted(folder_ / "0.exr") + " " + quoted(folder_ / "10.exr"));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("10x10+10+0 of 20x10"), std::string::npos) << result.errors;
}

TEST_F(Diff, BrightPicturesAreToldOf) {
    write_image(folder_ / "bright.exr", constant_image(20, 10, {"R", "G", "B"}, 5.0f));
    const std::string files = quoted(a_) + " " + quoted(folder_ / "bright.exr");
    EXPECT_NE(run_program("diff " + files).errors.find("--exposure"), std::string::npos);
    const ProgramResult darker = run_program("diff --json --exposure -3 " + files);
    EXPECT_EQ(darker.errors, "");
    EXPECT_GT(nlohmann::json::parse(darker.output)["layers"][0]["flip"], 0.1);
}

TEST_F(Diff, GreysAreAPicture) {
    write_image(folder_ / "a.exr", constant_image(4, 4, {"Y"}, 0.25f));
    write_image(folder_ / "b.exr", constant_image(4, 4, {"Y"}, 0.5f));
    const ProgramResult result =
        run_program("diff --json " + quoted(folder_ / "a.exr") + " " + quoted(folder_ / "b.exr"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NEAR(nlohmann::json::parse(result.output)["layers"][0]["mean_ratio"], 0.5, 1e-6);
}

TEST_F(Diff, NumbersOfMattesAreNoColours) {
    const Image mattes =
        constant_image(4, 4, {"R", "G", "B", "Object00.R", "Object00.G", "Object00.B"}, 0.5f);
    write_image(folder_ / "m.exr", mattes,
                {.metadata = {{"cryptomatte/1234567/name", std::string("Object")}}});
    const std::string file = quoted(folder_ / "m.exr");
    const ProgramResult result = run_program("diff --json " + file + " " + file);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["layers"].size(), 1u);
}

TEST_F(Diff, OldMapSurvivesFailure) {
    const auto map = folder_ / "map.png";
    ASSERT_EQ(run_program("diff " + both_ + " -o " + quoted(map)).exit_code, 0);
    const std::string old_text = file_text(map);
    EXPECT_EQ(run_program("diff " + both_ + " --layer none -o " + quoted(map)).exit_code, 3);
    EXPECT_EQ(file_text(map), old_text);
    EXPECT_EQ(run_program("diff " + both_ + " -o " + quoted(folder_ / "none/map.png")).exit_code, 3);
    EXPECT_EQ(run_program("diff " + both_ + " -o " + quoted(folder_ / "map.gif")).exit_code, 2);
}

}  // namespace
}  // namespace nearlight::core
