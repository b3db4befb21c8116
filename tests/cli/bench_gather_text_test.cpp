// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_gather_text.h"

#include <gtest/gtest.h>

namespace nearlight::core::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++found;
    }
    return found;
}

/// The result for Embree with one ray and with 16, coherent or not, and for our kernel. The coherent one is
/// wrong for 400 of a million rays, of which the first hundred are listed; our kernel differs for one ray.
GatherBenchResult made_up_result() {
    GatherBenchResult result;
    result.after_culling = 1'000'000;
    result.tracers = {{.name = "rtcOccluded1"},
                      {.name = "incoherent", .embree_width = 16},
                      {.name = "coherent", .embree_width = 16, .disagreements = 400, .is_wrong = true},
                      {.name = "packets", .disagreements = 1}};
    result.tracers[0].embree_width = 1;
    for (TracerFigures& tracer : result.tracers) {
        tracer.median = {1.0, 1.0};
    }
    for (std::size_t i = 0; i < 100; ++i) {
        result.disagreements.push_back({.tracer = "coherent", .vpl = i});
    }
    result.disagreements.push_back({.tracer = "packets", .excused = true});
    result.ours = 3;
    result.embree16 = 1;
    result.wall1 = result.wall16 = {2.0, 0.1};
    result.agrees = true;
    return result;
}

TEST(GatherBenchText, ItemisesTenRaysOfATracerAndCountsTheRest) {
    const std::string text = gather_bench_text("room", BvhQuality::quality, made_up_result());
    EXPECT_EQ(count(text, "  coherent passes packet"), 10u) << text;
    EXPECT_NE(text.find("coherent differs for 390 more rays"), std::string::npos) << text;
    EXPECT_EQ(count(text, "  packets passes packet"), 1u) << text;
    EXPECT_EQ(count(text, "more rays"), 1u) << text;
}

TEST(GatherBenchText, SaysWhereEmbreeContradictsItself) {
    const std::string text = gather_bench_text("room", BvhQuality::quality, made_up_result());
    EXPECT_NE(text.find("Embree contradicts itself: coherent differs from rtcOccluded1 for 0.04 %"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("ours agree with Embree"), std::string::npos) << text;
    GatherBenchResult bad = made_up_result();
    bad.agrees = false;
    EXPECT_NE(gather_bench_text("room", BvhQuality::quality, bad).find("OURS DO NOT AGREE"),
              std::string::npos);
}

TEST(GatherBenchText, EndsWithTheRatios) {
    const std::string text = gather_bench_text("room", BvhQuality::quality, made_up_result());
    const std::string last = "packets 2.00 ± 0.10 times as fast as incoherent\n";
    ASSERT_GT(text.size(), last.size());
    EXPECT_EQ(text.substr(text.size() - last.size()), last);
}

}  // namespace
}  // namespace nearlight::core::test
