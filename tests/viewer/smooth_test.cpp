// SPDX-License-Identifier: Apache-2.0
#include "viewer/smooth.h"

#include <gtest/gtest.h>

#include "nearlight/session.h"

namespace nearlight::viewer {
namespace {

constexpr int kSide = 16;

void set(Image& image, int x, int y, const std::string& channel, float value) {
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        if (image.channels[i] == channel) {
            image.at(x, y, i) = value;
        }
    }
}

float get(const Image& image, int x, int y, const std::string& channel) {
    std::size_t i = 0;
    while (image.channels[i] != channel) {
        ++i;
    }
    return image.at(x, y, i);
}

/// A flat surface whose pixels have the pattern of interleaving, and 1 of direct light.
Image patterned() {
    Image image{.width = kSide, .height = kSide, .channels = picture_channels()};
    image.values.resize(kSide * kSide * image.channels.size());
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float albedo = x % 3 == 0 ? 0.2f : 0.8f;
            const auto light = static_cast<float>(4 * (y % 4) + x % 4);  // 7.5 on the average
            for (const char* const color : {"R", "G", "B"}) {
                set(image, x, y, std::string("albedo.") + color, albedo);
                set(image, x, y, std::string("indirect.") + color, albedo * light);
                set(image, x, y, std::string("direct.") + color, 1.0f);
                set(image, x, y, color, albedo * light + 1.0f);
            }
            set(image, x, y, "N.Z", 1.0f);
            set(image, x, y, "depth.Z", 2.0f);
        }
    }
    return image;
}

TEST(Smooth, TakesThePatternOutAndKeepsTextures) {
    Image image = patterned();
    smooth_interleaved(image, 4);
    for (int y = 4; y < kSide - 4; ++y) {
        for (int x = 4; x < kSide - 4; ++x) {
            const float albedo = x % 3 == 0 ? 0.2f : 0.8f;
            EXPECT_NEAR(get(image, x, y, "indirect.G"), 7.5f * albedo, 1e-3f);
            EXPECT_NEAR(get(image, x, y, "B"), 7.5f * albedo + 1.0f, 1e-3f);
            EXPECT_EQ(get(image, x, y, "direct.R"), 1.0f);
        }
    }
}

TEST(Smooth, StopsAtEdges) {
    Image image = patterned();
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const bool is_left = x < kSide / 2;
            set(image, x, y, "depth.Z", is_left ? 2.0f : 3.0f);
            set(image, x, y, "indirect.R", is_left ? 0.0f : get(image, x, y, "albedo.R"));
        }
    }
    smooth_interleaved(image, 4);
    EXPECT_EQ(get(image, kSide / 2 - 1, 8, "indirect.R"), 0.0f);
    EXPECT_NEAR(get(image, kSide / 2, 8, "indirect.R"), get(image, kSide / 2, 8, "albedo.R"), 1e-6f);
}

TEST(Smooth, LeavesWhatIsNoSurface) {
    Image image = patterned();
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            set(image, x, y, "depth.Z", 0.0f);
        }
    }
    const Image before = image;
    smooth_interleaved(image, 4);
    EXPECT_EQ(image.values, before.values);
}

}  // namespace
}  // namespace nearlight::viewer
