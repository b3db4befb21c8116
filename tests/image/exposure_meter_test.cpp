// SPDX-License-Identifier: Apache-2.0
#include "host/image/exposure_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr float kInfiniteDepth = std::numeric_limits<float>::infinity();

/// Pixels of one kind, all of a grey.
struct Part {
    int count = 1;
    float light = 0;
    float depth = 0;
    float albedo = 0;
};

float exposure_of(std::initializer_list<Part> parts) {
    ExposureMeter meter;
    for (const Part& part : parts) {
        for (int i = 0; i < part.count; ++i) {
            meter.add({part.light, part.light, part.light}, part.depth,
                      {part.albedo, part.albedo, part.albedo});
        }
    }
    return meter.exposure();
}

TEST(ExposureMeter, MakesTheMeanGreyAndKeepsLightsFromBurning) {
    EXPECT_NEAR(exposure_of({{.count = 100, .light = 0.01f}}), std::log2(25.0f), 1e-3f);
    EXPECT_NEAR(exposure_of({{.count = 80, .light = 0.01f}, {.count = 20, .light = 100.0f}}),
                std::log2(0.03f), 1e-3f);
}

TEST(ExposureMeter, BlackAndBadPixelsDoNotCount) {
    const float even = exposure_of({{.count = 100, .light = 0.01f}});
    EXPECT_NEAR(exposure_of({{.count = 100, .light = 0.01f}, {.count = 100}}), even, 1e-5f);
    EXPECT_NEAR(exposure_of({{.count = 100, .light = 0.01f}, {.light = NAN}, {.light = kInfiniteDepth}}),
                even, 1e-5f);
    EXPECT_EQ(exposure_of({{.count = 10}}), 0.0f);
    EXPECT_EQ(exposure_of({}), 0.0f);
}

/// What a mirror shows of a black background is hardly ever exactly 0.
TEST(ExposureMeter, WhatScreensShowBlackDoesNotCountEither) {
    const float even = exposure_of({{.count = 60, .light = 0.5f, .depth = 2}});
    EXPECT_NEAR(
        exposure_of({{.count = 60, .light = 0.5f, .depth = 2}, {.count = 40, .light = 1e-6f, .depth = 2}}),
        even, 1e-5f);
    EXPECT_NEAR(
        exposure_of({{.count = 60, .light = 0.5f, .depth = 2}, {.count = 40, .light = 2e-3f, .depth = 2}}),
        even + 0.4f * std::log2(250.0f), 1e-3f)
        << "what is only dark counts";
    EXPECT_NEAR(exposure_of({{.count = 10, .light = 1e-6f, .depth = 2}}), std::log2(0.25e6f), 1e-3f);
}

/// A surface that is eight times darker than another in the same light stays darker, but by the root of that
/// only.
TEST(ExposureMeter, SurfacesDecideByTheLightThatFallsOnThem) {
    const float white = exposure_of({{.light = 0.8f, .depth = 2, .albedo = 0.8f}});
    EXPECT_NEAR(white, std::log2(0.25f / 0.8f) + 0.5f * std::log2(0.8f / 0.4f), 1e-4f);
    EXPECT_NEAR(exposure_of({{.light = 0.1f, .depth = 2, .albedo = 0.1f}}), white + 1.5f, 1e-4f);
    EXPECT_NEAR(exposure_of({{.light = 0.1f, .depth = 2}}), std::log2(0.25f / 0.1f), 1e-4f);
}

TEST(ExposureMeter, TheBackgroundCountsOnlyByItself) {
    const Part wall{.light = 0.8f, .depth = 2, .albedo = 0.8f};
    EXPECT_EQ(exposure_of({wall, {.light = 50.0f}}), exposure_of({wall}));
    EXPECT_EQ(exposure_of({wall, {.light = 50.0f, .depth = kInfiniteDepth}}), exposure_of({wall}));
    EXPECT_NEAR(exposure_of({{.light = 0.5f}}), std::log2(0.25f / 0.5f), 1e-4f);
}

TEST(AutomaticExposure, FindsTheChannelsOfAPicture) {
    const std::vector<std::string> all{"depth.Z", "B", "G", "R", "albedo.B", "albedo.G", "albedo.R"};
    const std::vector<float> values{2, 0.8f, 0.8f, 0.8f, 0.4f, 0.4f, 0.4f, 0, 50, 50, 50, 0, 0, 0};
    EXPECT_NEAR(automatic_exposure(all, values), std::log2(0.25f / 0.8f), 1e-4f);
    const std::vector<std::string> beauty{"R", "G", "B"};
    EXPECT_NEAR(automatic_exposure(beauty, std::vector<float>(3, 0.8f)), std::log2(0.25f / 0.8f), 1e-4f);
    EXPECT_THROW(automatic_exposure(std::vector<std::string>{"Z"}, std::vector<float>{1}), Error);
}

}  // namespace
}  // namespace nearlight::core
