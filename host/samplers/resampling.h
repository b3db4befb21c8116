// SPDX-License-Identifier: Apache-2.0
// Chooses few VPLs out of many candidates, without bias.
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// The indices of the chosen candidates, in ascending order, and the factor for the power of each.
struct Choice {
    std::vector<uint> indices;
    std::vector<float> factors;
};

/// Probabilities p_i = min(1, weight_i / τ). τ is such that they add up to the wanted number, or to the
/// number of usable weights if that is lower. A weight that is not positive or not finite has the probability
/// 0.
struct Probabilities {
    std::vector<double> of;
    double tau = 0;  ///< 0: all usable weights are chosen for certain
};
Probabilities choice_probabilities(std::span<const float> weights, std::size_t wanted);

/// Systematic resampling without repeats. Candidate i is chosen with the probability p_i of
/// choice_probabilities(): equidistant points with one random shift are laid over the running sum of p.
/// Neighbours share these points evenly, so candidates should be in order along a curve. The factor of a
/// chosen candidate is 1 / p_i, which keeps the expectation of any sum over candidates, as long as weights
/// are positive wherever the summand is not 0. Chooses `wanted` candidates (rounding may make it one more or
/// less), or all usable ones if there are fewer.
/// @param shift uniform in [0, 1)
Choice resample(std::span<const float> weights, std::size_t wanted, double shift);

/// Returns the chosen candidates, with their powers multiplied by their factors.
std::vector<Vpl> take(const Choice& choice, std::span<const Vpl> candidates);

}  // namespace nearlight::core
