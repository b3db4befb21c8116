// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "host/image/image_io.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"

namespace nearlight::core {
namespace {

/// A scene whose camera looks from above at what is almost a single point.
std::string floor_from_above() {
    return lit_floor({.max_depth = 2, .fov_degrees = 0.1f, .origin = "0, 0, 3", .width = 8, .height = 6});
}

class Reference : public testing::Test {
  protected:
    Reference() { std::ofstream(scene_) << floor_from_above(); }
    [[nodiscard]] std::string files() const { return quoted(scene_) + " -o " + quoted(output_); }
    /// Expects that a command with these options ends with `exit_code` and says `part`.
    void expect_error(const std::string& options, int exit_code, const std::string& part) const {
        const ProgramResult result = run_program("reference " + options + " " + files());
        EXPECT_EQ(result.exit_code, exit_code) << options;
        EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    }
    void interrupt_endless_reference() const {
        const ProgramResult result =
            run_interrupted("reference --quiet --spp 16777216 " + files(), 1,
                            [&](const ProgramResult&) { return std::filesystem::exists(output_); });
        EXPECT_EQ(result.exit_code, 130) << result.errors;
    }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
    std::filesystem::path output_ = folder_ / "reference.exr";
};

TEST_F(Reference, WritesAllLayersAndTellsOfThemInJson) {
    const ProgramResult result = run_program("reference --json --spp 257 --seed 7 " + files());
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["width"], 8);
    EXPECT_EQ(json["height"], 6);
    EXPECT_EQ(json["max_depth"], 2);
    EXPECT_EQ(json["samples_per_pixel"], 272);
    EXPECT_EQ(json["seed"], 7);
    EXPECT_EQ(json["complete"], true);
    const Image image = read_image(output_);
    for (const char* channel : {"indirect.B", "albedo.G", "N.Z", "P.X", "depth.Z", "variance.R"}) {
        EXPECT_GE(image.find_channel(channel), 0) << channel;
    }
    EXPECT_NEAR(image.at(4, 3, static_cast<std::size_t>(image.find_channel("R"))), 0.5 / 3.14159265, 1e-4);
    EXPECT_NEAR(image.at(4, 3, static_cast<std::size_t>(image.find_channel("direct.B"))), 0.125 / 3.14159265,
                1e-4);
    EXPECT_NEAR(image.at(4, 3, static_cast<std::size_t>(image.find_channel("depth.Z"))), 3.0, 1e-4);
}

TEST_F(Reference, IndirectOnlyAndSizeAreObeyed) {
    const ProgramResult result = run_program("reference --spp 4 --indirect-only --size 5x3 " + files());
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "");
    const Image image = read_image(output_);
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.at(2, 1, static_cast<std::size_t>(image.find_channel("R"))), 0.0f);
}

TEST_F(Reference, PixelCentersAreTold) {
    const ProgramResult result = run_program("reference --json --spp 4 --pixel-centers " + files());
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["pixel_centers"], true);
    EXPECT_EQ(json["indirect_only"], false);
}

TEST_F(Reference, ResumingRefinesWhatIsThere) {
    const std::string options = "reference --json --seed 3 --max-depth 0 " + files();
    ASSERT_EQ(run_program(options + " --spp 16").exit_code, 0);
    const ProgramResult result = run_program(options + " --spp 24 --resume");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["samples_before"], 16);
    EXPECT_EQ(json["samples_per_pixel"], 24);
    const Image refined = read_image(output_);
    EXPECT_EQ(std::get<int>(read_metadata(output_).at("nearlight:samplesPerPixel")), 24);

    // Without an earlier picture, all samples are done at once, with the same result.
    std::filesystem::remove(output_);
    ASSERT_EQ(run_program(options + " --spp 24 --resume").exit_code, 0);
    const Image whole = read_image(output_);
    ASSERT_EQ(refined.channels, whole.channels);
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        ASSERT_NEAR(refined.values[i], whole.values[i], 2e-6f * std::abs(whole.values[i]) + 1e-9f)
            << whole.channels[i % whole.channel_count()];
    }
    const ProgramResult enough = run_program(options + " --spp 8 --resume");
    EXPECT_EQ(nlohmann::json::parse(enough.output)["samples_per_pixel"], 24);
}

/// A.EXR is an EXR file, too: it has all attributes, and no exposure is chosen for it.
TEST_F(Reference, ExtensionsMayBeInCapitals) {
    const std::filesystem::path capitals = folder_ / "reference.EXR";
    const std::string command = "reference --json --resume " + quoted(scene_) + " -o " + quoted(capitals);
    ASSERT_EQ(run_program(command + " --spp 4").exit_code, 0);
    EXPECT_FALSE(read_metadata(capitals).contains("nearlight:exposure"));
    const ProgramResult result = run_program(command + " --spp 8");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["samples_before"], 4);
}

TEST_F(Reference, AnAutomaticExposureIsTold) {
    const std::filesystem::path png = folder_ / "a.png";
    const std::string command = "reference --spp 4 " + files() + " -o " + quoted(png) + " -o " +
                                quoted(folder_ / "b.png") + " --tonemap agx --exposure ";
    const ProgramResult result = run_program(command + "auto");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    std::smatch told;
    const std::regex line(R"(exposure ([+-][0-9.]+) stops \(automatic\), tone curve agx\n)");
    ASSERT_TRUE(std::regex_search(result.errors, told, line)) << result.errors;
    EXPECT_FALSE(std::regex_search(told.suffix().first, told.suffix().second, line)) << "once for both files";
    const Metadata metadata = read_metadata(png);
    EXPECT_NEAR(std::stof(std::get<std::string>(metadata.at("nearlight:exposure"))), std::stof(told[1]),
                0.006f);
    EXPECT_EQ(std::get<std::string>(metadata.at("nearlight:tonemap")), "agx");
    EXPECT_EQ(run_program(command + "2").errors.find("automatic"), std::string::npos);
}

TEST_F(Reference, ResumingKeepsItsBatches) {
    ASSERT_EQ(run_program("reference --spp 16 " + files()).exit_code, 0);
    ASSERT_EQ(run_program("reference --spp 33 --resume " + files()).exit_code,
              0);  // a new picture has batches of 4
    const Metadata metadata = read_metadata(output_);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:samplesPerBatch")), 1);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:samplesPerPixel")), 33);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:pixelCenters")), 0);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:indirectOnly")), 0);
}

TEST_F(Reference, ResumingSomethingElseIsRefusedAndNamed) {
    ASSERT_EQ(run_program("reference --spp 4 " + files()).exit_code, 0);
    const std::string before = file_text(output_);
    const auto expect_refused = [&](const std::string& options, const std::string& named) {
        expect_error("--resume --spp 8 " + options, 3, named);
    };
    expect_refused("--clamp-radius 0.5", "it has --clamp-radius 0, not 0.5; use");
    expect_refused("--max-depth 7 --seed 9", "it has --max-depth 2, not 7; it has --seed 0, not 9; use");
    expect_refused("--indirect-only", "it lacks --indirect-only");
    expect_refused("--pixel-centers", "it lacks --pixel-centers");
    expect_refused("--size 4x3", "8x6 pixels, not 4x3");
    EXPECT_EQ(file_text(output_), before);
    std::ofstream(scene_, std::ios::app) << "\n";
    EXPECT_EQ(run_program("reference --resume --spp 4 " + files()).exit_code, 0)
        << "the same scene in other letters";
    std::string other = floor_from_above();
    other.replace(other.find("0.125"), 5, "0.126");
    std::ofstream(scene_) << other;
    expect_refused("", "it has another scene, camera, --filter or --glass");
    EXPECT_EQ(
        run_program("reference --resume " + quoted(scene_) + " -o " + quoted(folder_ / "a.png")).exit_code,
        2);
}

TEST_F(Reference, APictureOfAnotherCommandIsNotResumed) {
    const Image picture = make_image(8, 6, {"R", "G", "B"});
    write_image(output_, picture,
                {.metadata = {{"nearlight:sampler", "close-range"}, {"nearlight:seed", 0}}});
    expect_error("--resume --spp 4", 3, "reference.exr' was not made by `nearlight reference`");
    EXPECT_EQ(read_image(output_).channels, picture.channels) << "it is still there";
}

TEST_F(Reference, NumbersHaveRangesLikeThoseOfRender) {
    expect_error("--threads -1", 2, "--threads: '-1' is no whole number from 0 to 1024");
    expect_error("--max-depth foo", 2, "--max-depth: 'foo' is no whole number from 0 to 1024");
    expect_error("--seed -1", 2, "--seed: '-1' is no whole number from 0 to 18446744073709551615");
    EXPECT_EQ(run_program("reference --spp 4 --seed 18446744073709551615 " + files()).exit_code, 0);
}

TEST_F(Reference, OneThatHasHardlyBegunDoesNotReplaceAnOlderOne) {
    ASSERT_EQ(run_program("reference --spp 4 " + files()).exit_code, 0);
    const std::string before = file_text(output_);
    const auto was_kept = [](const ProgramResult& result) {
        return result.errors.find("older pictures were kept") != std::string::npos;
    };
    const ProgramResult result =
        run_interrupted("reference --spp 16777216 --size 1000x1000 " + files(), 1, was_kept);
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_TRUE(was_kept(result)) << result.errors;
    EXPECT_EQ(file_text(output_), before);
}

TEST_F(Reference, AnInterruptedOneGoesOn) {
    interrupt_endless_reference();
    Metadata metadata = read_metadata(output_);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:complete")), 0);
    const Image part = read_image(output_);
    const int samples =
        static_cast<int>(part.at(7, 5, static_cast<std::size_t>(part.find_channel("count.X"))));
    ASSERT_GT(samples, 0);
    ASSERT_EQ(
        run_program("reference --resume --spp " + std::to_string(samples + 64) + " " + files()).exit_code, 0);
    metadata = read_metadata(output_);
    EXPECT_EQ(std::get<int>(metadata.at("nearlight:complete")), 1);
    EXPECT_GE(std::get<int>(metadata.at("nearlight:samplesPerPixel")), samples + 64);
}

TEST_F(Reference, AnUnwritableOutputFailsBeforeTheWork) {
    const ProgramResult result = run_program("reference --spp 16777216 " + quoted(scene_) + " -o " +
                                             quoted(folder_ / "nowhere" / "a.exr"));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("nowhere"), std::string::npos);
    EXPECT_EQ(run_program("reference " + files() + " --spp 0").exit_code, 2);
    EXPECT_EQ(run_program("reference " + files() + " --clamp-radius -1").exit_code, 2);
}

TEST_F(Reference, CtrlCSavesWhatIsThere) {
    interrupt_endless_reference();
    const Image image = read_image(output_);
    EXPECT_NEAR(image.at(4, 3, static_cast<std::size_t>(image.find_channel("G"))), 0.25 / 3.14159265, 1e-4);
}

}  // namespace
}  // namespace nearlight::core
