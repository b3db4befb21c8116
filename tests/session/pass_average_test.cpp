// SPDX-License-Identifier: Apache-2.0
#include "host/session/pass_average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/session/relative_error.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

bool has_rule(std::size_t index, PassRule rule) {
    return pass_rules()[index % NEARLIGHT_LAYER_CHANNELS] == rule;
}

std::vector<float> sent_by(const PassAverage& average) {
    std::vector<float> sent;
    average.send([&](std::span<const float> row) { sent.insert(sent.end(), row.begin(), row.end()); });
    return sent;
}

/// The mean of the channel `channel` of all pixels.
double mean_of(const std::vector<float>& picture, std::size_t channel) {
    double sum = 0.0;
    for (std::size_t i = channel; i < picture.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        sum += picture[i];
    }
    return sum / static_cast<double>(picture.size() / NEARLIGHT_LAYER_CHANNELS);
}

TEST(PassAverage, DividesEachRowByThePassesThatReachedIt) {
    PassAverage average(1, 3);
    std::vector<float> rows(3 * NEARLIGHT_LAYER_CHANNELS, 1.0f);
    average.begin_pass();
    average.add_rows(rows);
    average.begin_pass();
    std::ranges::fill(rows, 4.0f);
    average.add_rows(std::span(rows).first(NEARLIGHT_LAYER_CHANNELS));
    average.add_rows(std::span(rows).first(NEARLIGHT_LAYER_CHANNELS));
    const std::vector<float> sent = sent_by(average);
    ASSERT_EQ(sent.size(), rows.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
        const bool reached_twice = i < 2 * NEARLIGHT_LAYER_CHANNELS;
        if (!has_rule(i, PassRule::variance)) {
            EXPECT_EQ(sent[i], has_rule(i, PassRule::mean) && reached_twice ? 2.5f : 1.0f) << i;
        }
    }
}

TEST(PassAverage, WeighsPasses) {
    PassAverage average(1, 1);
    const std::vector<float> ones(NEARLIGHT_LAYER_CHANNELS, 1.0f);
    const std::vector<float> fives(NEARLIGHT_LAYER_CHANNELS, 5.0f);
    average.begin_pass(3);
    average.add_rows(ones);
    EXPECT_EQ(sent_by(average), ones) << "a single pass is the picture, bit for bit";
    average.begin_pass(1);
    average.add_rows(fives);
    EXPECT_EQ(sent_by(average)[NEARLIGHT_LAYER_BEAUTY], 2.0f);
    EXPECT_EQ(sent_by(average)[NEARLIGHT_LAYER_DEPTH], 1.0f);
}

TEST(PassAverage, SendsNoRowThatNoPassReached) {
    PassAverage average(2, 3);
    average.add_rows(std::vector<float>(2 * NEARLIGHT_LAYER_CHANNELS, 1.0f));
    EXPECT_EQ(sent_by(average).size(), 2u * NEARLIGHT_LAYER_CHANNELS);
}

/// Passes of 64 × 64 pixels around 2 with the variance 0.36 ÷ samples. Each says of itself that it has
/// `own_factor` times that.
class NoisyPasses {
  public:
    explicit NoisyPasses(float own_factor) : own_factor_(own_factor) {}

    void add(PassAverage& average, uint samples) {
        const float variance = 0.36f / static_cast<float>(samples);
        std::normal_distribution<float> noise(2.0f, std::sqrt(variance));
        std::vector<float> rows(kSide * kSide * NEARLIGHT_LAYER_CHANNELS);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows[i] = has_rule(i, PassRule::variance) ? own_factor_ * variance : noise(random_);
        }
        average.begin_pass(samples);
        average.add_rows(rows);
    }

    static constexpr uint kSide = 64;

  private:
    float own_factor_;
    std::mt19937 random_{1};
};

TEST(PassAverage, TheVarianceOfOnePassIsItsOwn) {
    PassAverage average(NoisyPasses::kSide, NoisyPasses::kSide);
    NoisyPasses(2.0f).add(average, 4);
    EXPECT_NEAR(mean_of(sent_by(average), NEARLIGHT_LAYER_VARIANCE), 0.18, 1e-6);
}

TEST(PassAverage, TheSpreadOfPassesCorrectsTheirOwnVariances) {
    for (const float own_factor : {0.0f, 0.3f, 1.0f, 3.0f}) {
        PassAverage average(NoisyPasses::kSide, NoisyPasses::kSide);
        NoisyPasses passes(own_factor);
        for (const uint samples : {4u, 4u, 4u, 2u}) {
            passes.add(average, samples);
        }
        // One part in four of the factor of the passes' own variances, which are one part in four, is still
        // their own word.
        const double expected = 0.09 / 3.5 * (1.0 + (own_factor > 0.0f ? (own_factor - 1.0) / 16 : 0.0));
        EXPECT_NEAR(mean_of(sent_by(average), NEARLIGHT_LAYER_VARIANCE) / expected, 1.0, 0.03) << own_factor;
        EXPECT_NEAR(average.error(), std::sqrt(expected / (4.0 + 0.04)), 0.05 * average.error())
            << own_factor;
    }
}

TEST(RelativeError, IsTheRootOfTheMeanOfTheQuotients) {
    const std::vector<float> beauty(3 * 20 * 10, 0.5f);
    const std::vector<float> norms = error_norms(beauty, 20);
    for (const float norm : norms) {
        EXPECT_NEAR(norm, 0.25 * 1.01, 1e-6);
    }
    std::vector<float> variances(beauty.size(), 0.01f);
    EXPECT_NEAR(relative_error(variances, norms), std::sqrt(0.01 / 0.2525), 1e-6);
}

TEST(RelativeError, NormsAreThoseOfTiles) {
    // Two tiles in a row, of which the second is cut by the edge: one of 1, one of 3, except that one pixel
    // of the second is 9 brighter.
    std::vector<float> beauty(3 * 12, 1.0f);
    std::fill(beauty.begin() + 3 * 8, beauty.end(), 3.0f);
    for (std::size_t c = 0; c < 3; ++c) {
        beauty[3 * 10 + c] += 9.0f;
    }
    const std::vector<float> norms = error_norms(beauty, 12);
    const double mean = (8 * 1.0 + 4 * 3.0 + 9.0) / 12;
    EXPECT_NEAR(norms[0], 1.0 + 0.01 * mean * mean, 1e-5);
    EXPECT_NEAR(norms[3 * 8], 5.25 * 5.25 + 0.01 * mean * mean, 1e-4);
    EXPECT_EQ(norms[3 * 8], norms[3 * 10]);
}

TEST(RelativeError, LeavesTheWorstThousandthOut) {
    const std::vector<float> norms(3 * 2000, 1.0f);
    std::vector<float> variances(norms.size(), 0.04f);
    variances[300] = 1e6f;
    variances[900] = 1e6f;
    EXPECT_NEAR(relative_error(variances, norms), 0.2, 1e-6);
    variances[1500] = 1e6f;
    EXPECT_GT(relative_error(variances, norms), 1.0);
}

TEST(RelativeError, OfABlackPictureIsZero) {
    const std::vector<float> black(3, 0.0f);
    EXPECT_EQ(relative_error(black, error_norms(black, 1)), 0.0);
    EXPECT_EQ(relative_error({}, {}), 0.0);
}

}  // namespace
}  // namespace nearlight::core
