// SPDX-License-Identifier: Apache-2.0
#include "host/image/rendered_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace nearlight::core {
namespace {

constexpr int kSide = 64;
constexpr std::size_t kPixels = std::size_t{kSide} * kSide;

/// A grey picture with noise of a known standard deviation, and one without, whose pixels err by `bias`, up
/// and down by turns.
struct NoisyGrey {
    NoisyGrey(float noise, float bias) : rendered(3 * kPixels), denoised(3 * kPixels) {
        std::mt19937 random(7);
        std::normal_distribution<float> normal(0.0f, 1.0f);
        for (std::size_t i = 0; i < rendered.size(); ++i) {
            rendered[i] = 1.0f + noise * normal(random);
            denoised[i] = i / 3 % 2 == 0 ? 1.0f + bias : 1.0f - bias;
        }
        variance.assign(3 * kPixels, noise * noise);
    }
    [[nodiscard]] std::vector<float> shares() const {
        return rendered_shares({kSide, kSide, rendered, denoised, variance});
    }

    std::vector<float> rendered;
    std::vector<float> denoised;
    std::vector<float> variance;
};

double mean_of(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(RenderedShare, NoiseIsNotKept) {
    EXPECT_LT(mean_of(NoisyGrey(0.2f, 0.0f).shares()), 0.01);
}

TEST(RenderedShare, DetailIsKept) {
    EXPECT_GT(mean_of(NoisyGrey(0.01f, 0.2f).shares()), 0.99);
}

/// As large an error on either side: 1.5 of the two parts of a squared change are noise.
TEST(RenderedShare, TheShareFollowsFromBothErrors) {
    EXPECT_NEAR(mean_of(NoisyGrey(0.1f, 0.1f).shares()), 0.25, 0.03);
    EXPECT_NEAR(mean_of(NoisyGrey(0.1f, 0.2f).shares()), 0.7, 0.02);
}

TEST(RenderedShare, TheMixtureErrsLessThanEither) {
    for (const float bias : {0.15f, 0.2f, 0.3f}) {
        const NoisyGrey grey(0.15f, bias);
        const std::vector<float> shares = grey.shares();
        double error_of_rendered = 0.0;
        double error_of_denoised = 0.0;
        double error = 0.0;
        for (std::size_t i = 0; i < grey.rendered.size(); ++i) {
            const float mixed = std::lerp(grey.denoised[i], grey.rendered[i], shares[i / 3]);
            error_of_rendered += std::pow(grey.rendered[i] - 1.0, 2);
            error_of_denoised += std::pow(grey.denoised[i] - 1.0, 2);
            error += std::pow(mixed - 1.0, 2);
        }
        EXPECT_LT(error, error_of_denoised) << bias;
        EXPECT_LT(error, error_of_rendered) << bias;
    }
}

/// Dark and bright pixels side by side, with detail in the dark ones alone.
TEST(RenderedShare, DarkDetailCountsBesideBrightNoise) {
    NoisyGrey grey(0.0f, 0.0f);
    for (std::size_t i = 0; i < kPixels; ++i) {
        const bool is_bright = i % kSide >= kSide / 2;
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
            grey.denoised[k] = is_bright ? 10.0f : 1.0f;
            grey.rendered[k] = is_bright ? 10.5f : 1.5f;
            grey.variance[k] = is_bright ? 0.25f : 1e-4f;
        }
    }
    const std::vector<float> shares = grey.shares();
    EXPECT_GT(shares[kPixels / 2 + kSide / 2 - 1], 0.9f) << "dark, at the edge";
    EXPECT_EQ(shares[kPixels / 2 + kSide - 1], 0.0f) << "bright";
}

TEST(RenderedShare, WhereNothingIsKnownNothingIsKept) {
    NoisyGrey grey(0.01f, 0.2f);
    grey.variance[3 * (kPixels / 2 + kSide / 2)] = std::numeric_limits<float>::infinity();
    const std::vector<float> shares = grey.shares();
    EXPECT_EQ(shares[kPixels / 2 + kSide / 2 + 3], 0.0f);
    EXPECT_GT(shares[kPixels / 2 + kSide / 2 + 4], 0.9f);
}

TEST(RenderedShare, EqualAndBlackPicturesHaveSharesOfZero) {
    NoisyGrey grey(0.0f, 0.0f);
    EXPECT_EQ(std::ranges::count(grey.shares(), 0.0f), std::ptrdiff_t{kPixels});
    std::ranges::fill(grey.rendered, 0.0f);
    std::ranges::fill(grey.denoised, 0.0f);
    EXPECT_EQ(std::ranges::count(grey.shares(), 0.0f), std::ptrdiff_t{kPixels});
}

TEST(RenderedShare, SmallPicturesHaveSmallWindows) {
    const std::vector<float> rendered{1, 1, 1, 2, 2, 2};
    const std::vector<float> denoised{1, 1, 1, 1, 1, 1};
    const std::vector<float> variance(6, 0.0f);
    EXPECT_EQ(rendered_shares({2, 1, rendered, denoised, variance}), (std::vector<float>{1, 1}));
    EXPECT_EQ(rendered_shares({1, 2, rendered, denoised, variance}), (std::vector<float>{1, 1}));
}

}  // namespace
}  // namespace nearlight::core
