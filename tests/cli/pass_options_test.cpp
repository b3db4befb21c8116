// SPDX-License-Identifier: Apache-2.0
// --time, --error and --pass-spp, tried with the real program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/cli/pass_list.h"
#include "host/image/image_io.h"
#include "nearlight/error.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

bool says(const ProgramResult& result, const std::string& part) {
    return result.errors.find(part) != std::string::npos;
}

class PassOptionsOfRender : public testing::Test {
  protected:
    PassOptionsOfRender() { write(floor_and_wall()); }

    void write(const std::string& scene) const { std::ofstream(scene_) << scene; }
    [[nodiscard]] ProgramResult render(const std::string& options) const {
        return run_program("render --json --vpls 100 --spp 4 " + options + " " + quoted(scene_) + " -o " +
                           quoted(output_));
    }
    [[nodiscard]] nlohmann::json rendered(const std::string& options) const {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
    std::filesystem::path output_ = folder_ / "picture.exr";
};

TEST(PassList, IsReadAsItIsWritten) {
    for (const std::vector<uint>& samples :
         {std::vector<uint>{16}, {16, 16, 16, 7}, {2, 16, 16, 3, 3}, {1, 2, 3}}) {
        EXPECT_EQ(parse_pass_list(pass_list_text(samples)), samples) << pass_list_text(samples);
    }
    EXPECT_EQ(pass_list_text(std::vector<uint>{16, 16, 16, 7}), "16*3,7");
}

TEST(PassList, RefusesWhatIsNone) {
    for (const char* text :
         {"", "0", "16,", ",16", "16*0", "16*", "-3", "16 * 2", "many", "70000", "9*2000000"}) {
        EXPECT_THROW(parse_pass_list(text), Error) << text;
    }
}

TEST_F(PassOptionsOfRender, AnErrorIsReachedReportedAndRepeated) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = render("--error 0.03 --layers variance");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(says(result, "is expected after")) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["relative_error_asked"], 0.03);
    EXPECT_LE(json["relative_error"].get<double>(), 0.03);
    EXPECT_GT(json["relative_error"].get<double>(), 0.015);
    EXPECT_GT(json["passes"].get<int>(), 1);
    const Metadata metadata = read_metadata(output_);
    EXPECT_EQ(metadata.at("nearlight:passSpp"), Metadata::mapped_type{json["pass_spp"].get<std::string>()});
    EXPECT_EQ(metadata.at("nearlight:errorAsked"), Metadata::mapped_type{0.03f});
    EXPECT_GE(read_image(output_).find_channel("variance.G"), 0);
    const nlohmann::json again = rendered("--pass-spp " + json["pass_spp"].get<std::string>());
    EXPECT_EQ(again["image_hash"], json["image_hash"]);
    EXPECT_EQ(again["pass_spp"], json["pass_spp"]);
    EXPECT_EQ(again["relative_error"], nullptr);
}

TEST_F(PassOptionsOfRender, ATimeIsUsedAndRepeated) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json = rendered("--time 3");
    EXPECT_EQ(rendered("--pass-spp " + json["pass_spp"].get<std::string>())["image_hash"],
              json["image_hash"]);
}

TEST_F(PassOptionsOfRender, ATimeShorterThanOneSampleGivesTwoSamples) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = render("--time 0.001");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(says(result, "shorter than 2 samples per pixel")) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["pass_spp"], "2");
}

TEST_F(PassOptionsOfRender, ABlackPictureIsExactAtOnce) {
    NEARLIGHT_NEEDS_DEVICE();
    write(
        "<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'><point name='center' z='3'/>"
        "</shape></scene>");
    const nlohmann::json json = rendered("--error 0.001 --size 16x16");
    EXPECT_EQ(json["passes"], 1);
    EXPECT_EQ(json["relative_error"], 0.0);
}

TEST_F(PassOptionsOfRender, AnErrorOutOfReachEndsAtTheBoundOfPasses) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = render("--error 0.00001 --passes 3");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(says(result, "beyond the limits")) << result.errors;
    EXPECT_TRUE(says(result, "the limit is 3 passes")) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["passes"], 3);
}

/// One sample per pixel says nothing about its error, and certainly not that it is 0.
TEST_F(PassOptionsOfRender, TheErrorOfASingleSampleIsUnknown) {
    NEARLIGHT_NEEDS_DEVICE();
    const auto single = [&](const std::string& options) {
        const ProgramResult result = run_program("render --json --spp 1 --vpls 50 " + quoted(scene_) +
                                                 " -o " + quoted(output_) + options);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    };
    EXPECT_TRUE(single(" --error 100 --passes 1")["relative_error"].is_null());
    const nlohmann::json json = single(" --error 100");
    EXPECT_GE(json["passes"].get<int>(), 2);
    EXPECT_GT(json["relative_error"].get<double>(), 0.0);
}

TEST_F(PassOptionsOfRender, APictureOfOnePixelHasAnError) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json = rendered("--error 0.5 --size 1x1 --layers variance");
    EXPECT_GE(json["passes"].get<int>(), 8) << "two halves of one pixel may be alike by chance";
    EXPECT_LE(json["relative_error"].get<double>(), 0.5);
}

TEST_F(PassOptionsOfRender, RefusesErrorsAndListsThatAreNone) {
    for (const char* options :
         {"--error 0", "--error -1", "--error nan", "--error small", "--time nan", "--pass-spp 0",
          "--pass-spp 4,", "--pass-spp 4 --passes 2", "--pass-spp 4 --time 1", "--pass-spp 4 --error 0.1",
          "--spp 1 --layers variance"}) {
        const ProgramResult result = render(options);
        ASSERT_EQ(result.exit_code, 2) << options;
        EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(output_));
    }
}

TEST_F(PassOptionsOfRender, VarianceOfASingleSampleIsRefusedOrWarnedOf) {
    NEARLIGHT_NEEDS_DEVICE();
    EXPECT_EQ(render("--layers variance --pass-spp 1").exit_code, 2);
    const ProgramResult hurried = run_program("render --vpls 10 --spp 1 --time 0 --layers variance " +
                                              quoted(scene_) + " -o " + quoted(output_));
    EXPECT_EQ(hurried.exit_code, 0) << hurried.errors;
    EXPECT_TRUE(says(hurried, "the layer variance is 0 and says nothing")) << hurried.errors;
    EXPECT_FALSE(says(render("--layers variance --pass-spp 1,1"), "says nothing"));
}

TEST_F(PassOptionsOfRender, PassesWithoutSplatsAreToldOf) {
    NEARLIGHT_NEEDS_DEVICE();
    constexpr const char* kWarning = "--pass-spp has passes of fewer than 4 samples";
    EXPECT_TRUE(says(render("--filter gaussian --pass-spp 4,2"), kWarning));
    EXPECT_FALSE(says(render("--filter gaussian --pass-spp 2,2"), kWarning)) << "all are alike";
    EXPECT_FALSE(says(render("--filter gaussian --splat off --pass-spp 4,2"), kWarning));
    EXPECT_FALSE(says(render("--filter box --pass-spp 4,2"), kWarning)) << "no samples are splats";
}

TEST_F(PassOptionsOfRender, VplsOfAFileAreRefusedBeforeTheSceneIsRead) {
    for (const char* passes : {"--passes 2", "--time 1", "--error 0.1", "--pass-spp 4,4"}) {
        const ProgramResult result =
            run_program("render --load-vpls none.ply no-such-scene.xml -o " + quoted(output_) + " " + passes);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_TRUE(says(result, "--load-vpls needs a picture of one pass")) << result.errors;
    }
}

}  // namespace
}  // namespace nearlight::core
