// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

const std::string kSmall = "--size 24x16 --vpls 5 --repeats 1 ";

class BenchGather : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "room.segments";
};

TEST_F(BenchGather, DumpedSegmentsReplayTheSameWork) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult dumped =
        run_program("bench gather spheres:2000 --json --dump " + quoted(file_) + " " + kSmall);
    ASSERT_EQ(dumped.exit_code, 0) << dumped.errors;
    const ProgramResult replayed = run_program("bench gather --repeats 1 --json --replay " + quoted(file_));
    ASSERT_EQ(replayed.exit_code, 0) << replayed.errors;
    const nlohmann::json first = nlohmann::json::parse(dumped.output);
    const nlohmann::json second = nlohmann::json::parse(replayed.output);
    EXPECT_EQ(first["pairs"], 24 * 16 * 5);
    for (const char* key : {"triangles", "pairs", "after_culling", "rays_traced"}) {
        EXPECT_EQ(first[key], second[key]) << key;
    }
    ASSERT_EQ(first["tracers"].size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(first["tracers"][i]["occluded"], second["tracers"][i]["occluded"]);
        EXPECT_GT(first["tracers"][i]["mpairs_per_second"], 0.0);
    }
    EXPECT_TRUE(first["agrees"]);
    EXPECT_GT(first["ratio_embree16"]["median"], 0.0);
}

TEST_F(BenchGather, TextForPeople) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program("bench gather spheres:2000 --kernel packets " + kSmall);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("rtcOccluded16 coherent, quality high"), std::string::npos);
    EXPECT_NE(result.output.find("ours agree with Embree"), std::string::npos);
    EXPECT_EQ(result.output.find("nearlight rays"), std::string::npos);
}

TEST_F(BenchGather, RouletteTracesFewerRays) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program(
        "bench gather spheres:2000 --json --rendered --roulette 4 --kernel packets "
        "--size 24x16 --vpls 50 --repeats 1");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json["tracers"].size(), 10u);
    const nlohmann::json& roulette = json["tracers"][9];
    EXPECT_EQ(roulette["tracer"], "nearlight packets, roulette");
    EXPECT_LT(roulette["rays"], json["after_culling"]);
    EXPECT_GT(roulette["rays"], 0);
    EXPECT_GT(json["ratio_roulette"]["median"], 0.0);
}

TEST_F(BenchGather, WantsASceneOrAFile) {
    EXPECT_EQ(run_program("bench gather").exit_code, 2);
    EXPECT_EQ(run_program("bench gather spheres:2000 --replay " + quoted(file_)).exit_code, 2);
    EXPECT_EQ(run_program("bench gather spheres:none").exit_code, 2);
    EXPECT_EQ(run_program("bench gather --replay " + quoted(file_)).exit_code, 3);
    std::ofstream(file_) << "NLSEGM01, but no more";
    const ProgramResult result = run_program("bench gather --replay " + quoted(file_));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("header"), std::string::npos) << result.errors;
}

TEST(BenchBuild, JsonTellsOfOurTreesAndEmbrees) {
    const ProgramResult result = run_program("bench build spheres:3000 --json " + kSmall);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["scene"].get<std::string>().substr(0, 11), "sphere-room");
    EXPECT_GT(json["triangles"], 2000);
    EXPECT_GT(json["rays"], 0);
    EXPECT_GT(json["packets"], 0);
    EXPECT_LT(json["occluded"], json["rays"]);
    std::vector<std::string> names;
    for (const nlohmann::json& tree : json["trees"]) {
        names.push_back(tree["name"]);
        EXPECT_GE(tree["duplication"], 0.0) << tree;
        for (const char* key : {"seconds", "sah_cost", "nodes", "depth", "nodes_per_ray", "triangles_per_ray",
                                "nodes_per_packet", "triangles_per_packet"}) {
            EXPECT_GT(tree[key], 0.0) << key << " of " << tree;
        }
    }
    EXPECT_EQ(names, (std::vector<std::string>{"nearlight fast", "nearlight quality", "Embree medium",
                                               "Embree high"}));
    for (const char* key : {"ratio_seconds", "ratio_ray_steps", "ratio_packet_steps"}) {
        EXPECT_GT(json[key], 0.0) << key;
    }
}

TEST(BenchBuild, TextForPeople) {
    const ProgramResult result = run_program("bench build spheres:3000 " + kSmall);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("nodes/packet"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("nearlight quality / Embree high"), std::string::npos) << result.output;
}

TEST(BenchBuild, WantsASceneAndSaneNumbers) {
    EXPECT_EQ(run_program("bench build").exit_code, 2);
    EXPECT_EQ(run_program("bench build spheres:none").exit_code, 2);
    EXPECT_EQ(run_program("bench build spheres:3000 --repeats 0").exit_code, 2);
    EXPECT_EQ(run_program("bench build spheres:3000 --vpls 0").exit_code, 2);
    EXPECT_EQ(run_program("bench build no-such-file.xml").exit_code, 3);
}

TEST(BenchTrace, RaysOfCameraAndWalks) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string small = "bench trace spheres:2000 --size 24x16 --rays 300 --repeats 1 ";
    const ProgramResult result = run_program(small + "--json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json["sets"].size(), 2u);
    EXPECT_EQ(json["sets"][0]["count"], 24 * 16);
    EXPECT_EQ(json["sets"][1]["count"], 300);
    for (const nlohmann::json& set : json["sets"]) {
        EXPECT_TRUE(set["agrees"]);
        EXPECT_EQ(set["tracers"].size(), 9u);
        EXPECT_GT(set["ratio"], 0.0);
    }
    const ProgramResult text = run_program(small);
    EXPECT_NE(text.output.find("light walks: "), std::string::npos) << text.output;
    EXPECT_NE(text.output.find("rtcIntersect16 coherent, quality high"), std::string::npos);
    EXPECT_EQ(run_program(small + "--rays 0").exit_code, 2);
}

TEST(BenchSort, RatiosToOtherSorts) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program("bench sort --count 20000 --repeats 2 --json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    ASSERT_EQ(json["figures"].size(), 6u);
    for (const nlohmann::json& figures : json["figures"]) {
        EXPECT_TRUE(figures["is_right"]) << figures["name"];
        EXPECT_GT(figures["seconds"], 0.0);
    }
    ASSERT_EQ(json["ratios"].size(), 5u);
    EXPECT_EQ(json["ratios"][1]["name"], "sort ÷ tbb::parallel_sort");
    EXPECT_GT(json["ratios"][1]["wall"], 0.0);
}

TEST(Bench, NamesItsCommands) {
    const ProgramResult unknown = run_program("bench gathr");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.errors.find("unknown command 'gathr', did you mean 'gather'?"), std::string::npos)
        << unknown.errors;
    EXPECT_NE(unknown.errors.find("nearlight bench --help"), std::string::npos) << unknown.errors;
    EXPECT_EQ(run_program("bench").exit_code, 2);
    const ProgramResult option = run_program("bench gather --vpl 5");
    EXPECT_NE(option.errors.find("'nearlight bench gather --help'"), std::string::npos) << option.errors;
}

}  // namespace
}  // namespace nearlight::core
