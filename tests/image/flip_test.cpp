// SPDX-License-Identifier: Apache-2.0
#include "host/image/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/base/math.h"
#include "host/base/random.h"

namespace nearlight::core {
namespace {

using Pixels = std::vector<Vec3>;

double mean_flip(int width, int height, const Pixels& a, const Pixels& b) {
    const std::vector<float> error = flip_error(width, height, a, b);
    EXPECT_EQ(error.size(), a.size());
    for (const float value : error) {
        EXPECT_GE(value, 0.0f);
        EXPECT_LE(value, 1.0f);
    }
    return std::accumulate(error.begin(), error.end(), 0.0) / static_cast<double>(error.size());
}

Pixels constant(int count, Vec3 color) {
    return Pixels(static_cast<std::size_t>(count), color);
}

Pixels checkerboard(int width, int height, int cell) {
    Pixels pixels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            pixels.push_back((x / cell + y / cell) % 2 == 0 ? Vec3{0.8f, 0.3f, 0.1f}
                                                            : Vec3{0.05f, 0.1f, 0.4f});
        }
    }
    return pixels;
}

/// The picture in which each pixel is the mean of the (2·radius + 1)² pixels around it.
Pixels blurred(int width, int height, const Pixels& pixels, int radius) {
    Pixels result;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Vec3 sum{0, 0, 0};
            for (int dy = -radius; dy <= radius; ++dy) {
                for (int dx = -radius; dx <= radius; ++dx) {
                    const int row = std::clamp(y + dy, 0, height - 1);
                    const int column = std::clamp(x + dx, 0, width - 1);
                    sum += pixels[static_cast<std::size_t>(row * width + column)];
                }
            }
            result.push_back(sum / static_cast<float>((2 * radius + 1) * (2 * radius + 1)));
        }
    }
    return result;
}

TEST(Flip, SamePicturesAreZero) {
    const Pixels pixels = checkerboard(40, 30, 5);
    EXPECT_EQ(mean_flip(40, 30, pixels, pixels), 0.0);
}

TEST(Flip, GreenAgainstBlueIsTheLargestError) {
    EXPECT_NEAR(mean_flip(24, 24, constant(576, {0, 1, 0}), constant(576, {0, 0, 1})), 1.0, 1e-3);
}

TEST(Flip, BlackAgainstWhite) {
    // L* differs by 100, so the compressed error is 100^0.7 = 25.119. Green and blue, the farthest colours,
    // have L* 87.74 and 32.30 and Hunt-adjusted a* −75.6 and 25.6, b* 73.0 and −34.8: 203.2^0.7 = 41.27.
    const double largest = std::pow(203.2, 0.7);
    const double expected = 0.95 + (std::pow(100.0, 0.7) - 0.4 * largest) / (0.6 * largest) * 0.05;
    const double error = mean_flip(24, 24, constant(576, {0, 0, 0}), constant(576, {1, 1, 1}));
    EXPECT_NEAR(error, expected, 1e-3);
}

TEST(Flip, ConstantGreysFollowTheFormula) {
    // Without features and colour, the error is 0.95 / (0.4 · 41.27) · |ΔL*|^0.7 as long as it is small.
    const double lightness_a = 116.0 * std::cbrt(0.20) - 16.0;
    const double lightness_b = 116.0 * std::cbrt(0.25) - 16.0;
    const double expected = 0.95 / (0.4 * std::pow(203.2, 0.7)) * std::pow(lightness_b - lightness_a, 0.7);
    const double error =
        mean_flip(30, 30, constant(900, {0.20f, 0.20f, 0.20f}), constant(900, {0.25f, 0.25f, 0.25f}));
    EXPECT_NEAR(error, expected, 2e-3);
}

TEST(Flip, Symmetric) {
    const Pixels a = checkerboard(48, 32, 6);
    const Pixels b = blurred(48, 32, a, 2);
    EXPECT_NEAR(mean_flip(48, 32, a, b), mean_flip(48, 32, b, a), 1e-6);
}

TEST(Flip, GrowsWithBlurAndNoise) {
    const Pixels sharp = checkerboard(64, 48, 12);
    double last = 0.0;
    for (int radius = 1; radius <= 5; ++radius) {
        const double error = mean_flip(64, 48, sharp, blurred(64, 48, sharp, radius));
        EXPECT_GT(error, last) << radius;
        last = error;
    }
    last = 0.0;
    for (const float strength : {0.02f, 0.05f, 0.1f, 0.3f}) {
        Pixels noisy = sharp;
        Pcg32 random(5);
        for (Vec3& pixel : noisy) {
            pixel += Vec3{1, 1, 1} * (strength * (random.uniform() - 0.5f));
        }
        const double error = mean_flip(64, 48, sharp, noisy);
        EXPECT_GT(error, last) << strength;
        last = error;
    }
}

TEST(Flip, FinePatternsBlendAtAViewingDistance) {
    // Black and white stripes one pixel wide, at 67 pixels per degree, look almost like a shifted copy of
    // themselves.
    Pixels even;
    Pixels odd;
    for (int i = 0; i < 64 * 64; ++i) {
        even.push_back(i % 2 == 0 ? Vec3{1, 1, 1} : Vec3{0, 0, 0});
        odd.push_back(i % 2 == 1 ? Vec3{1, 1, 1} : Vec3{0, 0, 0});
    }
    EXPECT_LT(mean_flip(64, 64, even, odd), 0.2);
    EXPECT_GT(mean_flip(64, 64, constant(64 * 64, {0, 0, 0}), constant(64 * 64, {1, 1, 1})), 0.9);
}

TEST(Flip, TinyPicturesAndBrightOnesAreFine) {
    EXPECT_NEAR(mean_flip(1, 1, {{0, 0, 0}}, {{1, 1, 1}}), 0.967, 2e-3);
    EXPECT_GT(mean_flip(1, 3, constant(3, {0, 0, 0}), constant(3, {1, 0, 0})), 0.3);
    // Values above white count as white.
    EXPECT_EQ(mean_flip(3, 2, constant(6, {1, 1, 1}), constant(6, {50, 90, 7})), 0.0);
}

}  // namespace
}  // namespace nearlight::core
