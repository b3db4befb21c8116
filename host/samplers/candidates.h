// SPDX-License-Identifier: Apache-2.0
// Weights of candidates, and the choice among them, for samplers that choose VPLs out of many candidates.
#pragma once

#include <span>
#include <vector>

#include "host/base/random.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sampler.h"

namespace nearlight::core {

/// Weights in proportion to which candidates are to be chosen: what each brings to the camera, in the given
/// norm, plus a tenth that follows the error that a candidate would leave if nothing hid it, and a hundredth
/// that follows power alone. Because of these parts, candidates that the importons do not see are chosen now
/// and then.
std::vector<float> choice_weights(SamplerStages& stages, const SamplingTask& task,
                                  std::span<const Vpl> candidates, ContributionNorm norm);

/// Estimates from many importons of what candidates bring to the picture.
struct JudgedCandidates {
    std::vector<float> weights;  ///< as choice_weights(), by the error that each would leave
    std::vector<float> rows;     ///< GroupContribution::rows; empty if there are too many to keep
};

JudgedCandidates judge(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates);

/// Draws `wanted` candidates along the Morton curve in proportion to `weights`, so that together they bring
/// to every part of the picture what all candidates would (balanced_choice.h). The factor of each is 1 / its
/// probability. `rows` are those of judge(); if they are empty, they are computed again.
Choice choose_balanced(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates,
                       std::span<const float> rows, std::span<const float> weights, std::size_t wanted,
                       Pcg32 random);

}  // namespace nearlight::core
