// SPDX-License-Identifier: Apache-2.0
// What samplers that choose VPLs out of many candidates want to know about them.
#pragma once

#include <span>
#include <vector>

#include "host/base/random.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sampler.h"

namespace nearlight::core {

/// In proportion to the probabilities that candidates are to be chosen with: what each brings to the camera,
/// in the given norm, and a small part that follows power alone, so that a candidate is chosen now and then
/// even where the sample of the view does not see it.
std::vector<float> choice_weights(SamplerStages& stages, const SamplingTask& task,
                                  std::span<const Vpl> candidates, ContributionNorm norm);

/// What candidates bring to the picture, by many importons.
struct JudgedCandidates {
    std::vector<float> weights;  ///< by the error each would leave, as of choice_weights()
    std::vector<float> rows;     ///< GroupContribution::rows; empty where they are too many to keep
};

JudgedCandidates judge(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates);

/// Draws `wanted` of the candidates in proportion to `weights`, those together that bring to every part of
/// the picture what all would (balanced_choice.h), along the Morton curve. As with resample(), each counts 1
/// / its probability. `rows` as judge() has found them: where they were not kept, they are found again.
Choice choose_balanced(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates,
                       std::span<const float> rows, std::span<const float> weights, std::size_t wanted,
                       Pcg32 random);

}  // namespace nearlight::core
