// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/cl/devices/device_list.h"
#include "host/image/image_io.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

class Compare : public testing::Test {
  protected:
    Compare() { std::ofstream(scene_) << floor_and_wall(); }
    [[nodiscard]] std::string command(const std::string& options) const {
        return "compare " + quoted(scene_) + " -o " + quoted(output_) + " " + options;
    }
    /// Options of a comparison that is small enough for a test.
    static constexpr const char* kSmall = "--size 16x12 --vpls 20,60 --seeds 2 --reference-spp 32 ";

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
    std::filesystem::path output_ = folder_ / "report";
};

TEST_F(Compare, WritesAReportAndOneJsonObject) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program(command(std::string(kSmall) + "--json"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    const auto& scene = json.at("scenes").at(0);
    const std::size_t rows = scene.at("equal_vpls").size();
    EXPECT_GE(rows, 2u * 3u);
    EXPECT_EQ(scene.at("equal_rmse").at(0).at("rows").size(), rows / 2);
    EXPECT_EQ(scene.at("triangles"), 4);
    EXPECT_EQ(nlohmann::json::parse(file_text(output_ / "compare.json")), json);
    for (const char* file : {"report.html", "equal_vpls.csv", "equal_rmse.csv"}) {
        EXPECT_GT(file_text(output_ / file).size(), 100u) << file;
    }
    // The second run reuses everything and has the same errors.
    const ProgramResult again = run_program(command(std::string(kSmall) + "--json"));
    const nlohmann::json second = nlohmann::json::parse(again.output);
    EXPECT_EQ(second.at("cells").at("measured"), 0);
    EXPECT_EQ(second.at("scenes").at(0).at("equal_vpls"), scene.at("equal_vpls"));
}

TEST_F(Compare, PrintsATableForPeopleAndNothingWithQuiet) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string options = std::string(kSmall) + "--samplers instant-radiosity,close-range:paper ";
    const ProgramResult table = run_program(command(options));
    ASSERT_EQ(table.exit_code, 0) << table.errors;
    EXPECT_NE(table.output.find("close-range:paper"), std::string::npos);
    EXPECT_NE(table.errors.find("report.html"), std::string::npos);
    const ProgramResult quiet = run_program(command(options + "--quiet"));
    EXPECT_EQ(quiet.output + quiet.errors, "");
}

TEST_F(Compare, TakesAnySamplersVplsAsReference) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result =
        run_program(command("--size 16x12 --vpls 20 --seeds 2 --samplers rejection --json "
                            "--reference-sampler close-range:partition --reference-vpls 400"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json reference = nlohmann::json::parse(result.output).at("scenes").at(0).at("reference");
    EXPECT_EQ(reference.at("method"), "close-range:partition");
    EXPECT_EQ(reference.at("samples"), 400);
    EXPECT_GT(reference.at("noise"), 0);
}

TEST_F(Compare, TakesAReferenceOfTheReferenceCommand) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string truth = quoted(folder_ / "truth.exr");
    const auto make = [&](const std::string& options) {
        return run_program("reference " + quoted(scene_) + " -o " + truth + " --spp 32 --clamp-radius 0.1 " +
                           options);
    };
    ASSERT_EQ(make("--size 16x12 --pixel-centers").exit_code, 0);
    const ProgramResult taken = run_program(command(std::string(kSmall) + "--json --reference " + truth));
    ASSERT_EQ(taken.exit_code, 0) << taken.errors;
    const nlohmann::json scene = nlohmann::json::parse(taken.output).at("scenes").at(0);
    EXPECT_FLOAT_EQ(scene.at("clamp_radius").get<float>(), 0.1f);
    EXPECT_EQ(scene.at("reference").at("samples"), 32);
    ASSERT_EQ(make("--size 24x12").exit_code, 0);
    const ProgramResult refused = run_program(command(std::string(kSmall) + "--reference " + truth));
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.errors.find("24x12"), std::string::npos);
}

TEST_F(Compare, CtrlCKeepsWhatWasMeasured) {
    NEARLIGHT_NEEDS_DEVICE();
    const char* promise = "rerun the same command to resume";
    const ProgramResult result = run_interrupted(
        command("--size 64x48 --vpls 1000,2000 --seeds 10000 --reference-spp 8"), 2,
        [&](const ProgramResult& so_far) { return so_far.errors.find(promise) != std::string::npos; });
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.errors.find(promise), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(output_ / "report.html"));
}

TEST_F(Compare, BadOptionsAreFoundBeforeAnyWork) {
    const auto expect_usage_error = [&](const std::string& options, const char* part) {
        const ProgramResult result = run_program(command(options));
        EXPECT_EQ(result.exit_code, 2) << options;
        EXPECT_NE(result.errors.find(part), std::string::npos) << options << ": " << result.errors;
        EXPECT_EQ(result.output, "");
    };
    expect_usage_error("--samplers instant-radiosty", "close-range:paper");
    expect_usage_error("--samplers ''", "--samplers is empty");
    expect_usage_error("--vpls 0,abc", "--vpls");
    expect_usage_error("--vpls ''", "--vpls");
    expect_usage_error("--vpls 100,100", "twice");
    expect_usage_error("--samplers instant-radiosity,instant-radiosity", "twice");
    expect_usage_error("--seeds 0", "--seeds");
    expect_usage_error("--size 0x5", "size");
    expect_usage_error("--samplers instant-radiosity --baseline close-range", "--baseline");
    expect_usage_error("--clamp-radius 0.1 --clamp-fraction 0.1", "--clamp-fraction");
    expect_usage_error("--clamp-radius -1", "--clamp-radius");
    expect_usage_error("--crop 1,2,3", "--crop");
    expect_usage_error("--crop 100x100+300+200", "--crop");
    expect_usage_error("--crop 100x100+4294967290+200", "--crop");
    expect_usage_error("--reference-vpls 100", "200000");
    expect_usage_error("--reference-vpls 400000001", "no whole number from 1 to 400000000");
    expect_usage_error("--reference-sampler metropolis", "--reference-vpls");
    expect_usage_error("--reference-sampler metropolise --reference-vpls 500000", "choose one of: ");
    expect_usage_error(quoted(scene_), "twice");
    EXPECT_EQ(run_program("compare " + quoted(scene_)).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(Compare, BadFilesAreFoundBeforeAnyWork) {
    EXPECT_EQ(run_program("compare " + quoted(folder_ / "no.xml") + " -o " + quoted(output_)).exit_code, 3);
    EXPECT_EQ(run_program("compare " + quoted(scene_) + " -o " + quoted(scene_)).exit_code, 3);
    EXPECT_EQ(run_program(command("--reference " + quoted(folder_ / "no.exr"))).exit_code, 3);
    EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
}  // namespace nearlight::core
