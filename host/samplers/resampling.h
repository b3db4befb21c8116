// SPDX-License-Identifier: Apache-2.0
// Fewer VPLs out of many candidates, without bias.
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Which candidates were chosen, ascending, and the factor for the power of each.
struct Choice {
    std::vector<uint> indices;
    std::vector<float> factors;
};

/// p_i = min(1, weight_i / τ) for each weight, τ such that they add up to `wanted`, or to as many as there
/// are; 0 for weights that are not positive (or not finite).
struct Probabilities {
    std::vector<double> of;
    double tau = 0;  ///< 0: all are chosen for certain
};
Probabilities choice_probabilities(std::span<const float> weights, std::size_t wanted);

/// Systematic resampling without repeats: candidate i is chosen with probability p_i = min(1, weight_i / τ),
/// τ such that `wanted` are chosen in expectation, by equidistant points with one random shift over the
/// running sum of p, so that neighbours share their points evenly: order candidates along a curve. Its factor
/// is 1 / p_i, so the expectation of any sum over candidates is kept, whatever the weights, as long as they
/// are positive wherever the summand is not 0. Weights that are not positive (or not finite) are never
/// chosen. `wanted` are chosen (one more or less by rounding), or all there are.
/// @param shift uniform in [0, 1)
Choice resample(std::span<const float> weights, std::size_t wanted, double shift);

/// The chosen candidates, powers multiplied by their factors.
std::vector<Vpl> take(const Choice& choice, std::span<const Vpl> candidates);

}  // namespace nearlight::core
