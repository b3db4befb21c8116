// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/candidates.h"

#include "host/base/math.h"

namespace nearlight {
namespace {

/// Of the choice, that follows power alone.
constexpr double kBlindPart = 0.1;

/// Adds to `weights`, which sum up to something else than 0 unless the view sees none of the candidates.
void add_blind_part(std::span<const Vpl> candidates, std::span<float> weights) {
    double seen = 0;
    double power = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        seen += weights[i];
        power += luminance(candidates[i].power);
    }
    if (power > 0) {
        const auto per_watt = static_cast<float>((seen > 0 ? kBlindPart * seen : 1.0) / power);
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            weights[i] += per_watt * luminance(candidates[i].power);
        }
    }
}

}  // namespace

std::vector<float> choice_weights(SamplerStages& stages, const SamplingTask& task,
                                  std::span<const Vpl> candidates, ContributionNorm norm) {
    const Buffer<Vpl> vpls(stages.device, candidates);
    Buffer<float> contribution(stages.device, candidates.size());
    stages.vpl_contribution.run(task.scene, vpls, candidates.size(), task.view, task.clamp_radius,
                                contribution, norm);
    std::vector<float> weights = contribution.download();
    add_blind_part(candidates, weights);
    return weights;
}

}  // namespace nearlight
