// SPDX-License-Identifier: Apache-2.0
// Draws few out of many candidates so that those drawn do together what all would have done.
//
// Candidate i is drawn with a probability p_i that is given, and counts 1/p_i, so that any sum over
// candidates keeps its expectation. Which are drawn together is free, and is settled by balance [Deville &
// Tillé, Efficient balanced sampling: the cube method, Biometrika 2004]: of each candidate a row of numbers
// c_i is known (what it brings to parts of the picture), and Σ c_i/p_i over the drawn should be Σ c_i over
// all. The probabilities of those that are still open take a random walk in which each keeps its expectation,
// in directions that change Σ (c_i/p_i)·π_i least, until each is 0 or 1.
//
// Unlike the original, only a few neighbours along a curve through space are open at a time [as in Grafström
// & Tillé, Doubly balanced spatial sampling, Environmetrics 2013], so that what is not in the numbers is
// evened out nearby too; and there may be more numbers than open candidates, so that the direction is the
// best in the sense of least squares.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/base/random.h"
#include "host/samplers/resampling.h"

namespace nearlight::core {

class BalancedChoice {
  public:
    /// @param row_length numbers that are known of each candidate
    /// @param usual_length of the vectors c_i/p_i: how much the number of those drawn counts beside what they
    /// bring
    BalancedChoice(std::size_t row_length, double usual_length, Pcg32 random);

    /// The next candidate along the curve. One whose probability is not above 0 is never drawn, one of 1 or
    /// more for certain; these two need no row. Numbers that are not finite, or beyond 10¹⁵, count as 0.
    void offer(uint index, double probability, std::span<const float> row);

    /// Settles what is still open, and empties the choice.
    Choice finish();

  private:
    static constexpr std::size_t kMaxOpen = 32;
    using Direction = std::array<double, kMaxOpen>;  ///< by slot; 0 in those that are not open
    using Matrix = std::array<Direction, kMaxOpen>;
    struct Open {
        uint index = 0;
        double probability = 0;  ///< of being drawn, as things stand
        double factor = 0;       ///< 1 / the probability that it came with
        std::size_t arrival = 0;
    };
    /// How far the walk can go along a direction, and who has to stop it there.
    struct Limit {
        double step = 0;
        std::size_t who = 0;
        double probability = 0;  ///< of `who` there: 0 or 1
    };

    void add_products(std::size_t slot);
    void include(std::size_t slot);
    void exclude(std::size_t slot);
    void invert_again();
    [[nodiscard]] double mean_square() const;
    [[nodiscard]] std::size_t oldest() const;
    [[nodiscard]] Limit limit(const Direction& direction, double sign) const;
    void settle_one();
    void settle(std::size_t slot, bool drawn);

    std::size_t row_length_;
    float count_weight_;
    Pcg32 random_;
    std::size_t arrivals_ = 0;
    std::vector<Open> open_;
    std::vector<float>
        columns_;              ///< c_i/p_i and the count of each open candidate: number-major, kMaxOpen wide
    Matrix products_{};        ///< of columns with each other
    double usual_square_ = 0;  ///< of columns, when `inverse_` was begun
    double ridge_ = 1;
    Matrix inverse_{};            ///< of products + ridge
    std::size_t exclusions_ = 0;  ///< since it was begun
    std::vector<std::pair<uint, float>> drawn_;
};

}  // namespace nearlight::core
