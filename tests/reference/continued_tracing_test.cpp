// SPDX-License-Identifier: Apache-2.0
// Tests batches and seeds, and pictures that are stopped, saved and continued.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "host/reference/path_tracer.h"
#include "nearlight/error.h"
#include "tests/reference/small_light_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

TEST(PathTracer, SameBitsForAnyThreadCountOtherBitsForAnotherSeed) {
    const Scene scene = facing_squares(0.7f);
    PathTracerSettings settings{.width = 40, .height = 24, .spp = 8, .seed = 3, .threads = 1};
    const Image one = trace_paths(scene, settings);
    settings.threads = 4;
    EXPECT_EQ(one.values, trace_paths(scene, settings).values);
    settings.seed = 4;
    EXPECT_NE(one.values, trace_paths(scene, settings).values);
}

TEST(PathTracer, VarianceIsWhatRepeatedRenderingsShow) {
    const Scene scene = facing_squares(0.7f);
    constexpr int kRuns = 60;
    constexpr int kPixels = 36;
    std::vector<double> sum(kPixels), square(kPixels);
    double estimated = 0;
    for (int run = 0; run < kRuns; ++run) {
        const Image image = trace_paths(scene, {.width = 6,
                                                .height = 6,
                                                .spp = 64,
                                                .max_depth = 4,
                                                .seed = static_cast<std::uint64_t>(100 + run)});
        for (int pixel = 0; pixel < kPixels; ++pixel) {
            const double value = image.at(pixel % 6, pixel / 6, 0);
            sum[static_cast<std::size_t>(pixel)] += value / kRuns;
            square[static_cast<std::size_t>(pixel)] += value * value / kRuns;
        }
        estimated += channel_mean(image, "variance.R") / kRuns;
    }
    double observed = 0;
    for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
        observed += (square[pixel] - sum[pixel] * sum[pixel]) * kRuns / (kRuns - 1) / kPixels;
    }
    EXPECT_NEAR(estimated / observed, 1.0, 0.2);
}

TEST(PathTracer, StoppingKeepsTheMeanOfWhatIsThere) {
    const Scene scene = furnace(0.5f);
    int calls = 0;
    const Image image =
        trace_paths(scene, {.width = 32, .height = 32, .spp = 64, .max_depth = 2, .threads = 1},
                    [&](double fraction) { return ++calls < 10 && fraction < 1; });
    EXPECT_EQ(calls, 10);
    EXPECT_NEAR(channel_mean(image, "R"), 1.5, 0.1);
}

/// Checks that pictures are equal in all channels except for rounding of the sums to floats.
void expect_same_picture(const Image& a, const Image& b) {
    ASSERT_EQ(a.channels, b.channels);
    ASSERT_EQ(a.values.size(), b.values.size());
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        ASSERT_NEAR(a.values[i], b.values[i], 2e-6f * std::abs(a.values[i]) + 1e-9f)
            << a.channels[i % a.channel_count()] << " of pixel " << i / a.channel_count();
    }
}

TEST(PathTracer, GoingOnGivesWhatAllSamplesAtOnceGive) {
    const Scene scene = facing_squares(0.7f);
    for (const int batch_size : {1, 4, 16}) {
        PathTracerSettings settings{.width = 9, .height = 7, .spp = 160, .max_depth = 4};
        settings.batch_size = batch_size;
        const Image whole = trace_paths(scene, settings);
        settings.spp = 16;  // one of the largest batches, whose variance is not known yet
        Image parts = trace_paths(scene, settings);
        for (const int spp : {48, 160}) {
            settings.spp = spp;
            parts = trace_paths(scene, settings, {}, {.earlier = &parts});
        }
        expect_same_picture(parts, whole);
        settings.spp = 32;  // fewer samples than the picture has, so all are kept
        expect_same_picture(trace_paths(scene, settings, {}, {.earlier = &parts}), whole);
    }
}

TEST(PathTracer, AStoppedPictureCanBeGoneOnWith) {
    const Scene scene = facing_squares(0.7f);
    PathTracerSettings settings{.width = 40, .height = 40, .spp = 64, .max_depth = 3, .batch_size = 4};
    int calls = 0;
    const Image part = trace_paths(scene, settings, [&](double) { return ++calls < 20; });
    const auto samples = static_cast<std::size_t>(part.find_channel("count.X"));
    std::set<float> counts;
    for (std::size_t i = samples; i < part.values.size(); i += part.channel_count()) {
        counts.insert(part.values[i]);
    }
    EXPECT_EQ(counts, (std::set<float>{4, 8})) << "16 tiles and a few more";
    expect_same_picture(trace_paths(scene, settings, {}, {.earlier = &part}), trace_paths(scene, settings));
}

TEST(PathTracer, SavesThePictureSoFar) {
    const Scene scene = furnace(0.5f);
    std::vector<float> samples;
    const auto save = [&](const Image& image) {
        samples.push_back(image.at(3, 3, static_cast<std::size_t>(image.find_channel("count.X"))));
    };
    trace_paths(scene, {.width = 8, .height = 8, .spp = 12, .batch_size = 4}, {},
                {.save = save, .seconds_between_saves = 0});
    EXPECT_EQ(samples, (std::vector<float>{4, 8, 12}));
}

TEST(PathTracer, WhatIsNoEarlierPictureIsRefused) {
    const Scene scene = furnace(0.5f);
    PathTracerSettings settings{.width = 8, .height = 8, .spp = 12, .batch_size = 4};
    Image image = trace_paths(scene, settings);
    settings.batch_size = 16;
    EXPECT_THROW(trace_paths(scene, settings, {}, {.earlier = &image}), Error);
    settings = {.width = 9, .height = 8, .spp = 12, .batch_size = 4};
    EXPECT_THROW(trace_paths(scene, settings, {}, {.earlier = &image}), Error);
    settings.width = 8;
    image.channels[3] = "other";
    EXPECT_THROW(trace_paths(scene, settings, {}, {.earlier = &image}), Error);
    settings.batch_size = 5;
    EXPECT_THROW(trace_paths(scene, settings), Error);
}

}  // namespace
}  // namespace nearlight::core
