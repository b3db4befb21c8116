// SPDX-License-Identifier: Apache-2.0
// Discrete distributions as cumulative tables, made for random numbers of 24 bits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nearlight::core {

/// Cumulative distribution in proportion to `weights`; negative weights and NaN count as zero, infinity is
/// not allowed. Entry i is the sum of the probabilities up to and including i, so that the probability of i
/// is cdf[i] − cdf[i − 1] (cdf[0] for the first).
///
/// Entries are whole multiples of 2^-24 and the last is exactly 1: the differences are exact in single
/// precision, and a uniform random number of 24 bits selects i with exactly that probability. Every positive
/// weight gets at least 2^-24, so nothing that emits is ever lost, and a zero weight gets 0. All weights
/// zero: uniform. Fewer than 2^24 weights.
std::vector<float> cumulative_distribution(std::span<const double> weights);

/// Index of the first entry greater than u, which is in [0, 1): selects by a table made above.
std::size_t select(std::span<const float> cdf, float u);

}  // namespace nearlight::core
