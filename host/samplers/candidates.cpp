// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/candidates.h"

#include <algorithm>
#include <iterator>

#include "host/base/math.h"
#include "host/samplers/balanced_choice.h"

namespace nearlight {
namespace {

/// Of the choice, that follows power alone.
constexpr double kBlindPart = 0.1;
/// Candidates on the device at a time, so that device memory stays small.
constexpr std::size_t kMostInChunk = std::size_t{1} << 18u;
/// The same where a row of numbers is kept of each.
constexpr std::size_t kMostRowsInChunk = std::size_t{1} << 14u;

/// As many, at most, as one allocation has room for.
std::size_t chunk_size(const Device& device, std::size_t wanted, std::size_t bytes_each) {
    const std::size_t room = device.entry().max_allocation_bytes / std::max(bytes_each, 2 * sizeof(Vpl));
    return std::clamp<std::size_t>(room, 1, wanted);
}

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
    std::vector<float> weights;
    weights.reserve(candidates.size());
    const std::size_t chunk = chunk_size(stages.device, kMostInChunk, sizeof(Vpl));
    for (std::size_t first = 0; first < candidates.size(); first += chunk) {
        const std::span part = candidates.subspan(first, std::min(chunk, candidates.size() - first));
        const Buffer<Vpl> vpls(stages.device, part);
        Buffer<float> contribution(stages.device, part.size());
        stages.vpl_contribution.run(task.scene, vpls, part.size(), task.view, task.clamp_radius, contribution,
                                    norm);
        std::ranges::copy(contribution.download(), std::back_inserter(weights));
    }
    add_blind_part(candidates, weights);
    return weights;
}

Choice choose_balanced(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates,
                       std::span<const float> weights, std::size_t wanted, Pcg32 random) {
    const Probabilities probabilities = choice_probabilities(weights, wanted);
    const std::size_t row_length = 3 * task.view.importon_groups.size();
    BalancedChoice choice(row_length, probabilities.tau, random);
    std::vector<uint> order;  // of those that chance decides about: the others need no rows
    for (const uint index : stages.vpl_order.order(candidates)) {
        if (probabilities.of[index] >= 1) {
            choice.offer(index, 1.0, {});
        } else if (probabilities.of[index] > 0) {
            order.push_back(index);
        }
    }
    const std::size_t chunk = chunk_size(stages.device, kMostRowsInChunk, row_length * sizeof(float));
    for (std::size_t first = 0; first < order.size(); first += chunk) {
        const std::span part = std::span(order).subspan(first, std::min(chunk, order.size() - first));
        std::vector<Vpl> vpls;
        vpls.reserve(part.size());
        std::ranges::transform(part, std::back_inserter(vpls), [&](uint index) { return candidates[index]; });
        const std::vector<float> rows = stages.vpl_contribution.by_group(
            task.scene, Buffer<Vpl>(stages.device, std::span<const Vpl>(vpls)), vpls.size(), task.view,
            task.clamp_radius);
        for (std::size_t i = 0; i < part.size(); ++i) {
            choice.offer(part[i], probabilities.of[part[i]],
                         std::span(rows).subspan(i * row_length, row_length));
        }
    }
    return choice.finish();
}

}  // namespace nearlight
