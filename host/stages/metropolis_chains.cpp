// SPDX-License-Identifier: Apache-2.0
#include "host/stages/metropolis_chains.h"

#include <algorithm>
#include <span>
#include <vector>

#include "host/stages/light_tracer.h"
#include "kernels/shared/light_walk.h"

namespace nearlight::core {

uint walk_pair_count(uint bounce_count) {
    return NEARLIGHT_WALK_PAIRS_ON_LIGHT + NEARLIGHT_WALK_PAIRS_PER_STEP * bounce_count;
}

PathStates::PathStates(Device& device, std::size_t state_count, uint bounce_count)
    : count(static_cast<uint>(state_count)),
      pair_count(walk_pair_count(bounce_count)),
      numbers(device, state_count * pair_count * 2),
      vpls(device, state_count),
      targets(device, state_count) {}

Buffer<float> make_depth_cdf(Device& device, uint bounce_count, float mean_albedo) {
    const float survival = std::clamp(mean_albedo, kMinSurvival, kMaxSurvival);
    std::vector<float> cdf;
    double sum = 0;
    double weight = 1;
    for (uint depth = 0; depth < bounce_count; ++depth, weight = std::max(weight * survival, 1e-4)) {
        sum += weight;
        cdf.push_back(static_cast<float>(sum));
    }
    for (float& value : cdf) {
        value = static_cast<float>(value / sum);
    }
    return {device, std::span<const float>(cdf)};
}

MetropolisChains::MetropolisChains(Device& device, VplContribution& vpl_contribution)
    : device_(&device),
      vpl_contribution_(&vpl_contribution),
      program_(device, "metropolis_chains.cl"),
      seeds_(program_, "metropolis_seeds"),
      walks_(program_, "metropolis_walks"),
      targets_(program_, "metropolis_targets"),
      propose_(program_, "metropolis_propose"),
      accept_(program_, "metropolis_accept"),
      keep_(program_, "metropolis_keep"),
      morton_sort_(device),
      compaction_(device) {}

void MetropolisChains::evaluate(const PathSpace& space, PathStates& states) {
    Buffer<uint> order(*device_, states.count);
    Buffer<Vpl> sorted(*device_, states.count);
    Buffer<float> contribution(*device_, states.count);
    walks_.launch_items(states.count, space.scene, space.aim, space.depth_cdf, space.bounce_count,
                        states.numbers, states.count, states.vpls);
    morton_sort_.order(states.vpls, states.count, order);
    compaction_.gather(states.vpls, order, states.count, sorted);
    vpl_contribution_->run(space.scene, sorted, states.count, space.view, space.clamp_radius, contribution);
    targets_.launch_items(states.count, states.vpls, order, contribution, space.blind_target, states.count,
                          states.targets);
}

void MetropolisChains::seed(const PathSpace& space, const Buffer<uint>& indices, PathStates& states) {
    seeds_.launch_items(states.count, indices, states.count, states.pair_count, space.seed, states.numbers);
    evaluate(space, states);
}

void MetropolisChains::advance(const PathSpace& space, uint step, PathStates& chains, PathStates& proposed) {
    propose_.launch_items(chains.count, chains.numbers, chains.count, chains.pair_count, step, space.seed,
                          proposed.numbers);
    evaluate(space, proposed);
    accept_.launch_items(chains.count, proposed.numbers, proposed.vpls, proposed.targets, chains.count,
                         chains.pair_count, step, space.seed, chains.numbers, chains.vpls, chains.targets);
}

void MetropolisChains::keep(const PathStates& chains, float scale, Buffer<Vpl>& kept, std::size_t first) {
    keep_.launch_items(chains.count, chains.vpls, chains.targets, scale, chains.count,
                       static_cast<uint>(first), kept);
}

}  // namespace nearlight::core
