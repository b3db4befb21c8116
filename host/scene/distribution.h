// SPDX-License-Identifier: Apache-2.0
// Discrete distributions as cumulative tables, for random numbers of 24 bits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nearlight::core {

/// The cumulative distribution in proportion to `weights`; negative weights and NaN count as zero, infinity
/// is not allowed. Entry i is the sum of the probabilities up to and including i, so that the probability of
/// i is cdf[i] − cdf[i − 1] (cdf[0] for the first).
///
/// Entries are whole multiples of 2^-24 and the last is exactly 1: the differences are exact in single
/// precision, and a uniform random number of 24 bits selects i with exactly that probability. Every positive
/// weight gets at least 2^-24, so nothing that emits is ever lost, and a zero weight gets 0. If all weights
/// are zero, the distribution is uniform. Throws Error(ErrorKind::out_of_memory) if more than 2^23 weights
/// are positive, or if all of more than 2^23 are zero.
std::vector<float> cumulative_distribution(std::span<const double> weights);

/// The index that u, in [0, 1), selects from a cumulative distribution: that of the first entry greater than
/// u.
std::size_t select(std::span<const float> cdf, float u);

}  // namespace nearlight::core
