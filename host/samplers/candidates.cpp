// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/candidates.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "host/base/division.h"
#include "host/base/math.h"
#include "host/samplers/balanced_choice.h"

namespace nearlight::core {
namespace {

/// The parts of the weights that follow what candidates would leave if nothing were in the way, and power
/// alone. Few importons see a candidate that lights the picture through a window at an angle. Where most
/// power is elsewhere, as on the grounds around a house, power alone would choose it too seldom, and it would
/// outshine all others.
constexpr double kUnoccludedPart = 0.1;
constexpr double kPowerPart = 0.01;
/// The maximum number of candidates on the device at a time, which bounds device memory.
constexpr std::size_t kMaxAtOnce = std::size_t{1} << 18u;
/// The maximum number of candidates on the device at a time if their rows of numbers are computed.
constexpr std::size_t kMaxRowsAtOnce = std::size_t{1} << 15u;
/// The maximum number of candidates whose rows are kept: 96 MiB, which is enough for some 10 000 VPLs.
constexpr std::size_t kMaxRowsKept = std::size_t{1} << 17u;

/// The number of candidates to work on at a time: as many as one allocation has room for, at most `max_size`.
/// All parts have nearly the same size.
std::size_t part_size(const Device& device, std::size_t count, std::size_t max_size, std::size_t bytes_each) {
    const std::size_t room = device.entry().max_allocation_bytes / std::max(bytes_each, 2 * sizeof(Vpl));
    const std::size_t parts = divide_rounding_up(count, std::clamp<std::size_t>(room, 1, max_size));
    return divide_rounding_up(count, std::max<std::size_t>(parts, 1));
}

/// Calls visit(first, contribution) for all candidates, part by part, with the GroupContribution of a part
/// that begins at candidate `first`.
template <typename Visit>
void for_each_contribution(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates,
                           const Visit& visit) {
    const std::size_t packet_bytes = (1 + task.view.importon_groups.group_count) * sizeof(IrradiancePacket);
    const std::size_t size = part_size(stages.device, candidates.size(), kMaxRowsAtOnce,
                                       divide_rounding_up(packet_bytes, NEARLIGHT_PACKET_SIZE));
    for (std::size_t first = 0; first < candidates.size(); first += size) {
        const std::span part = candidates.subspan(first, std::min(size, candidates.size() - first));
        visit(first, stages.vpl_contribution.by_group(task.scene, Buffer<Vpl>(stages.device, part),
                                                      part.size(), task.view, task.clamp_radius));
    }
}

/// Adds `part` of all weights to those of candidates, in proportion to `shares`.
void add_part(double part, std::span<const float> shares, std::span<float> weights) {
    const double seen = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    if (all > 0) {
        const auto scale = static_cast<float>((seen > 0 ? part * seen : 1.0) / all);
        for (std::size_t i = 0; i < shares.size(); ++i) {
            weights[i] += scale * shares[i];
        }
    }
}

/// Adds the parts of the weights that do not know what hides candidates. If all weights are 0, because the
/// view sees no candidate, these parts are all.
void add_blind_parts(std::span<const Vpl> candidates, std::span<const float> unoccluded,
                     std::span<float> weights) {
    add_part(kUnoccludedPart, unoccluded, weights);
    std::vector<float> power(candidates.size());
    std::ranges::transform(candidates, power.begin(), [](const Vpl& vpl) { return luminance(vpl.power); });
    add_part(kPowerPart, power, weights);
}

}  // namespace

std::vector<float> choice_weights(SamplerStages& stages, const SamplingTask& task,
                                  std::span<const Vpl> candidates, ContributionNorm norm) {
    std::vector<float> weights;
    weights.reserve(candidates.size());
    std::vector<float> unoccluded;
    unoccluded.reserve(candidates.size());
    const std::size_t size = part_size(stages.device, candidates.size(), kMaxAtOnce, sizeof(Vpl));
    for (std::size_t first = 0; first < candidates.size(); first += size) {
        const std::span part = candidates.subspan(first, std::min(size, candidates.size() - first));
        const Buffer<Vpl> vpls(stages.device, part);
        Buffer<float> contribution(stages.device, part.size());
        stages.vpl_contribution.run(task.scene, vpls, part.size(), task.view, task.clamp_radius, contribution,
                                    norm);
        std::ranges::copy(contribution.download(), std::back_inserter(weights));
        std::ranges::copy(
            stages.vpl_contribution.unoccluded_errors(vpls, part.size(), task.view, task.clamp_radius),
            std::back_inserter(unoccluded));
    }
    add_blind_parts(candidates, unoccluded, weights);
    return weights;
}

JudgedCandidates judge(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates) {
    JudgedCandidates judged;
    const bool keep = candidates.size() <= kMaxRowsKept;
    judged.weights.reserve(candidates.size());
    judged.rows.reserve(keep ? candidates.size() * 3 * task.view.importon_groups.group_count : 0);
    std::vector<float> unoccluded;
    unoccluded.reserve(candidates.size());
    for_each_contribution(stages, task, candidates, [&](std::size_t, const GroupContribution& part) {
        judged.weights.insert(judged.weights.end(), part.errors.begin(), part.errors.end());
        unoccluded.insert(unoccluded.end(), part.unoccluded.begin(), part.unoccluded.end());
        if (keep) {
            judged.rows.insert(judged.rows.end(), part.rows.begin(), part.rows.end());
        }
    });
    add_blind_parts(candidates, unoccluded, judged.weights);
    return judged;
}

Choice choose_balanced(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> candidates,
                       std::span<const float> rows, std::span<const float> weights, std::size_t wanted,
                       Pcg32 random) {
    const Probabilities probabilities = choice_probabilities(weights, wanted);
    const std::size_t row_length = std::size_t{3} * task.view.importon_groups.group_count;
    BalancedChoice choice(row_length, probabilities.tau, random);
    std::vector<uint> order;  // candidates that chance decides about; the others need no rows
    for (const uint index : stages.vpl_order.order(candidates)) {
        if (probabilities.of[index] >= 1) {
            choice.offer(index, 1.0, {});
        } else if (probabilities.of[index] > 0) {
            order.push_back(index);
        }
    }
    const auto offer = [&](uint index, std::span<const float> from, std::size_t place) {
        choice.offer(index, probabilities.of[index], from.subspan(place * row_length, row_length));
    };
    if (rows.size() == candidates.size() * row_length) {
        std::ranges::for_each(order, [&](uint index) { offer(index, rows, index); });
        return choice.finish();
    }
    std::vector<Vpl> open;
    open.reserve(order.size());
    std::ranges::transform(order, std::back_inserter(open), [&](uint index) { return candidates[index]; });
    for_each_contribution(stages, task, open, [&](std::size_t first, const GroupContribution& part) {
        for (std::size_t i = 0; i < part.errors.size(); ++i) {
            offer(order[first + i], part.rows, i);
        }
    });
    return choice.finish();
}

}  // namespace nearlight::core
