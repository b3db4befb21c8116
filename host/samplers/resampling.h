// SPDX-License-Identifier: Apache-2.0
// Fewer VPLs out of many candidates, without bias.
#pragma once

#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight {

/// Which candidates were chosen, ascending, and the factor for the power of each.
struct Choice {
    std::vector<uint> indices;
    std::vector<float> factors;
};

/// Systematic resampling: candidate i is met n_i = wanted · weight_i / Σ weights times in expectation, by equidistant
/// points with one random shift over the running sum of weights, so that neighbours share their points evenly: order
/// candidates along a curve. A candidate that is met k times is chosen once, with factor k / n_i; the expectation of
/// any sum over candidates is kept, whatever the weights, as long as they are positive wherever the summand is not 0.
/// Weights that are not positive (or NaN) are never chosen. At most `wanted` + 1 are chosen.
/// @param shift uniform in [0, 1)
Choice resample(std::span<const float> weights, std::size_t wanted, double shift);

/// The chosen candidates, powers multiplied by their factors.
std::vector<Vpl> apply(const Choice& choice, std::span<const Vpl> candidates);

}  // namespace nearlight
