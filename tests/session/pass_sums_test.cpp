// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "host/session/pass_average.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kWidth = 5;
constexpr std::size_t kHeight = 3;

struct Pass {
    std::vector<float> rows;
    uint samples = 1;
};

/// Passes whose values are spread over `powers_of_two` and have either sign.
std::vector<Pass> random_passes(std::size_t count, float powers_of_two) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-powers_of_two / 2, powers_of_two / 2);
    std::vector<Pass> passes(count);
    for (Pass& pass : passes) {
        pass.samples = static_cast<uint>(1 + random() % 65536);
        for (std::size_t i = 0; i < kWidth * kHeight * NEARLIGHT_LAYER_CHANNELS; ++i) {
            const float sign = random() % 4 == 0 ? -1.0f : 1.0f;
            pass.rows.push_back(sign * std::exp2(exponent(random)));
        }
    }
    return passes;
}

void add(PassSums& sums, const Pass& pass) {
    const std::size_t row_size = kWidth * NEARLIGHT_LAYER_CHANNELS;
    for (std::size_t y = 0; y < kHeight; ++y) {
        sums.add_row(y, std::span(pass.rows).subspan(y * row_size, row_size), pass.samples);
    }
}

std::vector<DoubleSum> sums_of(const std::vector<Pass>& passes, std::span<const std::size_t> order) {
    PassSums sums(kWidth, kHeight);
    for (const std::size_t i : order) {
        add(sums, passes[i]);
    }
    return {sums.sums().begin(), sums.sums().end()};
}

TEST(PassSums, HaveTheSameBitsInEveryOrder) {
    const std::vector<Pass> passes = random_passes(100, 16.0f);
    std::vector<std::size_t> order(passes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::vector<DoubleSum> forward = sums_of(passes, order);
    std::mt19937 random(3);
    for (int turn = 0; turn < 5; ++turn) {
        std::ranges::shuffle(order, random);
        EXPECT_EQ(sums_of(passes, order), forward);
    }
    PassSums joined(kWidth, kHeight);
    for (std::size_t first = 0; first < passes.size(); first += 7) {
        PassSums part(kWidth, kHeight);
        for (std::size_t i = first; i < std::min(first + 7, passes.size()); ++i) {
            add(part, passes[i]);
        }
        joined.add(part);
    }
    EXPECT_TRUE(std::ranges::equal(joined.sums(), forward));
}

TEST(PassSums, AreThoseOfLongerNumbers) {
    const std::vector<Pass> passes = random_passes(200, 60.0f);
    PassSums sums(kWidth, kHeight);
    for (const Pass& pass : passes) {
        add(sums, pass);
    }
    for (std::size_t x = 0; x < kWidth; ++x) {
        for (const std::size_t channel :
             {std::size_t{NEARLIGHT_LAYER_BEAUTY}, std::size_t{NEARLIGHT_LAYER_ALPHA}}) {
            long double sum = 0.0L;
            long double samples = 0.0L;
            for (const Pass& pass : passes) {
                const float value = pass.rows[(kWidth + x) * NEARLIGHT_LAYER_CHANNELS + channel];
                sum += static_cast<long double>(value) * pass.samples;
                samples += pass.samples;
            }
            EXPECT_EQ(sums.value(x, 1, channel), static_cast<float>(sum / samples));
        }
        EXPECT_EQ(sums.value(x, 1, NEARLIGHT_LAYER_DEPTH),
                  passes[0].rows[(kWidth + x) * NEARLIGHT_LAYER_CHANNELS + NEARLIGHT_LAYER_DEPTH]);
    }
}

TEST(PassSums, FindASmallSpreadAboutALargeMean) {
    PassSums sums(kWidth, kHeight);
    Pass pass = random_passes(1, 0.0f).front();
    const float next = std::nextafter(1e4f, 2e4f);
    for (const float value : {1e4f, next, 1e4f, next}) {
        std::ranges::fill(pass.rows, value);
        add(sums, pass);
    }
    // Four values half a step beside their mean: the sum of squares is one step², the variance of the mean a
    // twelfth of it.
    const double step = double{next} - 1e4;
    EXPECT_FLOAT_EQ(sums.spread_variance(1, 1, 2), static_cast<float>(step * step / 12));
    std::ranges::fill(pass.rows, 1e4f);
    PassSums equal(kWidth, kHeight);
    add(equal, pass);
    EXPECT_EQ(equal.spread_variance(0, 0, 0), 0.0f);
    add(equal, pass);
    EXPECT_EQ(equal.spread_variance(0, 0, 0), 0.0f);
}

TEST(PassSums, APassWithoutANumberSpoilsItsOwnChannelsOnly) {
    std::vector<Pass> passes = random_passes(2, 4.0f);
    passes[0].rows[NEARLIGHT_LAYER_DIRECT] = std::numeric_limits<float>::infinity();
    passes[0].rows[NEARLIGHT_LAYER_INDIRECT] = std::numeric_limits<float>::quiet_NaN();
    PassSums sums(kWidth, kHeight);
    add(sums, passes[0]);
    add(sums, passes[1]);
    EXPECT_EQ(sums.value(0, 0, NEARLIGHT_LAYER_DIRECT), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(sums.value(0, 0, NEARLIGHT_LAYER_INDIRECT)));
    EXPECT_TRUE(std::isfinite(sums.value(0, 0, NEARLIGHT_LAYER_BEAUTY)));
    EXPECT_TRUE(std::isfinite(sums.value(1, 0, NEARLIGHT_LAYER_DIRECT)));
}

}  // namespace
}  // namespace nearlight::core
