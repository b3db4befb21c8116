// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/balanced_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nearlight::core {
namespace {

/// Candidates along a line; the third number of each is random. Their weights, like those of the policy
/// `complete`, are proportional to the length of the row.
struct Line {
    explicit Line(std::size_t count) {
        Pcg32 random(5);
        for (std::size_t i = 0; i < count; ++i) {
            const float at = static_cast<float>(i) / static_cast<float>(count);
            const float size = 0.2f + random.uniform();
            const std::array row{size * (1 - at), size * at, size * (random.uniform() < 0.5f ? 0.3f : 1.0f)};
            rows.insert(rows.end(), row.begin(), row.end());
            weights.push_back(std::hypot(row[0], row[1], row[2]));
        }
    }
    [[nodiscard]] std::span<const float> row(std::size_t i) const {
        return std::span(rows).subspan(3 * i, 3);
    }

    std::vector<float> rows, weights;
};

Choice draw(const Line& line, std::size_t wanted, std::uint64_t seed) {
    const Probabilities probabilities = choice_probabilities(line.weights, wanted);
    BalancedChoice choice(3, probabilities.tau, Pcg32(seed));
    for (std::size_t i = 0; i < line.weights.size(); ++i) {
        choice.offer(static_cast<uint>(i), probabilities.of[i], line.row(i));
    }
    return choice.finish();
}

/// Mean square error of the sums of the three numbers over the candidates that are drawn.
template <typename Draw>
double error_of_sums(const Line& line, const Draw& draw_once) {
    constexpr int kDraws = 200;
    double error = 0;
    for (int seed = 0; seed < kDraws; ++seed) {
        std::array<double, 3> difference{};
        for (std::size_t i = 0; i < line.rows.size(); ++i) {
            difference[i % 3] -= line.rows[i];
        }
        const Choice choice = draw_once(seed);
        for (std::size_t k = 0; k < choice.indices.size(); ++k) {
            for (std::size_t j = 0; j < 3; ++j) {
                difference[j] += choice.factors[k] * line.row(choice.indices[k])[j];
            }
        }
        error +=
            difference[0] * difference[0] + difference[1] * difference[1] + difference[2] * difference[2];
    }
    return error / kDraws;
}

TEST(BalancedChoice, DrawsEachWithItsProbability) {
    const Line line(60);
    constexpr std::size_t kWanted = 12;
    constexpr int kDraws = 20000;
    const Probabilities probabilities = choice_probabilities(line.weights, kWanted);
    std::vector<int> drawn(line.weights.size());
    for (int seed = 0; seed < kDraws; ++seed) {
        const Choice choice = draw(line, kWanted, static_cast<std::uint64_t>(seed));
        for (std::size_t k = 0; k < choice.indices.size(); ++k) {
            const uint index = choice.indices[k];
            ++drawn[index];
            EXPECT_FLOAT_EQ(choice.factors[k], static_cast<float>(1 / probabilities.of[index]));
        }
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const double p = probabilities.of[i];
        EXPECT_NEAR(drawn[i] / double{kDraws}, p, 4.5 * std::sqrt(p * (1 - p) / kDraws)) << i;
    }
}

TEST(BalancedChoice, BringsWhatAllWouldBetterThanEquidistantPoints) {
    const Line line(2000);
    constexpr std::size_t kWanted = 100;
    const double balanced =
        error_of_sums(line, [&](int seed) { return draw(line, kWanted, static_cast<std::uint64_t>(seed)); });
    const double systematic =
        error_of_sums(line, [&](int seed) { return resample(line.weights, kWanted, Pcg32(seed).uniform()); });
    EXPECT_LT(balanced, 0.2 * systematic);
}

/// Mean square error of the sums over candidates [first, last) when a fifth of all is drawn.
double error_of_part(const Line& line, std::size_t first, std::size_t last, bool balanced) {
    constexpr int kDraws = 100;
    double error = 0;
    for (int seed = 0; seed < kDraws; ++seed) {
        Pcg32 random(static_cast<std::uint64_t>(seed));
        BalancedChoice choice(balanced ? 3 : 0, 1.0, random);
        std::array<double, 3> difference{};
        for (std::size_t i = 0; i < line.weights.size(); ++i) {
            choice.offer(static_cast<uint>(i), 0.2, balanced ? line.row(i) : std::span<const float>());
        }
        const Choice drawn = choice.finish();
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t i = first; i < last; ++i) {
                difference[j] -= line.row(i)[j];
            }
            for (const uint index : drawn.indices) {
                difference[j] += first <= index && index < last ? 5.0 * line.row(index)[j] : 0.0;
            }
            error += difference[j] * difference[j];
        }
    }
    return error / kDraws;
}

TEST(BalancedChoice, BalancesLargeNumbersAndSmallOnes) {
    Line line(900);
    for (std::size_t i = 300; i < 600; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            line.rows[3 * i + j] *= 1e5f;
        }
    }
    for (const std::size_t first : {0u, 300u, 600u}) {
        EXPECT_LT(error_of_part(line, first, first + 300, true),
                  0.5 * error_of_part(line, first, first + 300, false))
            << "from " << first;
    }
}

TEST(BalancedChoice, DrawsAboutAsManyAsWanted) {
    const Line line(1000);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        EXPECT_NEAR(static_cast<double>(draw(line, 100, seed).indices.size()), 100, 3);
    }
}

TEST(BalancedChoice, WithoutNumbersOnlyTheCountIsBalanced) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        BalancedChoice choice(0, 1.0, Pcg32(seed));
        for (uint i = 0; i < 500; ++i) {
            choice.offer(i, 0.1, {});
        }
        EXPECT_NEAR(static_cast<double>(choice.finish().indices.size()), 50, 1);
    }
}

TEST(BalancedChoice, WhatIsCertainIsDrawnAndWhatHasNoProbabilityIsNot) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::array<float, 2> row{1, 2};
    const std::array<float, 2> broken{nan, std::numeric_limits<float>::infinity()};
    const std::array<float, 2> none{};
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        BalancedChoice choice(2, 1.0, Pcg32(seed));
        choice.offer(9, 1.0, row);
        choice.offer(3, 0.0, row);
        choice.offer(4, std::numeric_limits<double>::quiet_NaN(), row);
        choice.offer(5, 0.5, broken);
        choice.offer(6, 0.5, broken);
        choice.offer(7, 0.5, none);
        choice.offer(8, 0.5, none);
        const Choice drawn = choice.finish();
        EXPECT_TRUE(std::is_sorted(drawn.indices.begin(), drawn.indices.end()));
        EXPECT_EQ(drawn.indices.back(), 9u);
        EXPECT_EQ(drawn.factors.back(), 1.0f);
        EXPECT_EQ(drawn.indices.size(), 3u) << "two of four with one half each, and the certain one";
        for (const uint index : drawn.indices) {
            EXPECT_GE(index, 5u);
        }
        EXPECT_TRUE(choice.finish().indices.empty());
    }
}

}  // namespace
}  // namespace nearlight::core
