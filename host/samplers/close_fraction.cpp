// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/close_fraction.h"

#include <algorithm>
#include <cmath>

#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

constexpr uint kPilotWalks = 512;
constexpr uint kPilotSeed = 0x5a17u;

}  // namespace

KeepDeposits deposits_to_keep(Policy policy) {
    return policy == Policy::paper ? KeepDeposits::outside : KeepDeposits::indirect_inside;
}

uint close_vpl_count(float close_fraction, uint vpl_count) {
    const auto count = static_cast<uint>(std::llround(double{close_fraction} * vpl_count));
    return std::min(count, vpl_count);
}

float choose_close_fraction(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region) {
    // Patches replace the deposits of depth 1 in the close range, and walks must supply the others. Tracing
    // the same walks twice, once keeping all deposits and once keeping what the policy keeps, tells the two
    // apart.
    const LightWalks walks{.walk_count = kPilotWalks,
                           .bounce_count = task.bounce_count,
                           .seed = task.seed ^ kPilotSeed,
                           .aim = walk_aim(task)};
    const auto sum_of_squares = [&](KeepDeposits keep) {
        const std::vector<Vpl> vpls = stages.light_tracer.run(task.scene, region, keep, walks);
        const Buffer<Vpl> buffer(stages.device, std::span<const Vpl>(vpls));
        Buffer<float> contribution(stages.device, vpls.size());
        stages.vpl_contribution.run(task.scene, buffer, vpls.size(), task.view, task.clamp_radius,
                                    contribution);
        double sum = 0;
        for (const float c : contribution.download()) {
            sum += static_cast<double>(c) * c;
        }
        return sum;
    };
    const double all = sum_of_squares(KeepDeposits::all);
    const double kept = sum_of_squares(deposits_to_keep(task.policy));
    const double close = std::sqrt(std::max(all - kept, 0.0));
    const double distant = std::sqrt(kept);
    if (!(close > 0.0)) {
        return 0.1f;
    }
    return std::clamp(static_cast<float>(close / (close + distant)), 0.1f, 0.9f);
}

}  // namespace nearlight::core
