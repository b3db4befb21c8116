// SPDX-License-Identifier: Apache-2.0
// Draws few candidates out of many so that together they bring what all candidates would bring.
//
// Candidate i is drawn with a given probability p_i and has the weight 1/p_i, so that any sum over candidates
// keeps its expectation. That leaves open which candidates are drawn together. Balance decides it [Deville &
// Tillé, Efficient balanced sampling: the cube method, Biometrika 2004]: each candidate has a row of numbers
// c_i (what it brings to parts of the picture), and Σ c_i/p_i over the drawn candidates should be Σ c_i over
// all. The probabilities π_i of open candidates take a random walk in which each keeps its expectation, in
// directions that change Σ (c_i/p_i)·π_i least, until each is 0 or 1.
//
// Unlike the original, only a few neighbours along a curve through space are open at a time [as in Grafström
// & Tillé, Doubly balanced spatial sampling, Environmetrics 2013], so that light that is not in the numbers
// is balanced locally too. There may be more numbers than open candidates; the direction is then the best one
// in the least-squares sense.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "host/base/random.h"
#include "host/samplers/resampling.h"

namespace nearlight::core {

class BalancedChoice {
  public:
    /// @param row_length the length of each candidate's row of numbers
    /// @param usual_length a typical length of the vectors c_i/p_i, which weights the number of drawn
    /// candidates against what they bring
    BalancedChoice(std::size_t row_length, double usual_length, Pcg32 random);

    /// Takes the next candidate along the curve. A probability of 0 or less means that it is never drawn, 1
    /// or more that it is drawn for certain; neither needs a row. Numbers that are not finite or are beyond
    /// 10¹⁵ count as 0.
    void offer(uint index, double probability, std::span<const float> row);

    /// Settles all open candidates, returns the choice and empties it.
    Choice finish();

  private:
    static constexpr std::size_t kMaxOpen = 32;
    using Direction = std::array<double, kMaxOpen>;  ///< one number per slot; 0 if the slot is not open
    using Matrix = std::array<Direction, kMaxOpen>;
    struct Open {
        uint index = 0;
        double probability = 0;  ///< present probability of being drawn
        double factor = 0;       ///< 1 / the probability that it was offered with
        std::size_t arrival = 0;
    };
    /// How far the walk can go along a direction, and the slot whose probability then reaches 0 or 1.
    struct Limit {
        double step = 0;
        std::size_t who = 0;
        double probability = 0;  ///< which `who` reaches: 0 or 1
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
    /// c_i/p_i of open candidates and a row for their count, kMaxOpen floats per row.
    std::vector<float> columns_;
    Matrix products_{};        ///< dot products of the columns with each other
    double usual_square_ = 0;  ///< mean square of a column when `inverse_` was begun
    double ridge_ = 1;
    Matrix inverse_{};            ///< inverse of products + ridge
    std::size_t exclusions_ = 0;  ///< since `inverse_` was begun
    std::vector<std::pair<uint, float>> drawn_;
};

}  // namespace nearlight::core
