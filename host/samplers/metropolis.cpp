// SPDX-License-Identifier: Apache-2.0
// Metropolis instant radiosity [Segovia, Iehl & Péroche, Eurographics 2007]: VPLs are states of Markov chains
// that follow what VPLs bring to the camera, so that each brings the same.
//
// It differs from the original in these points, and is still unbiased:
// - A state is a point of primary sample space [Kelemen et al. 2002] that stands for a light walk to one
//   depth, not a path from the camera. A chain follows f = contribution to the camera + a small share of the
//   power, and the power of its states is multiplied by b / (f · number of states), where b is the mean of f.
// - The contribution is estimated over receivers that stay the same for the whole run. Given these, f is a
//   plain function, and acceptance and weight use the same one. Its share of power reaches VPLs that those
//   receivers miss.
// - Many short chains take their steps together, which keeps the device busy. They start from seeds that are
//   chosen in proportion to f, and b is the mean of f over the same seeds. So start-up leaves no bias,
//   however short a chain is [Veach 1997, §11.3.1].
// - All states of all chains are kept. States at even distances along the Morton curve, with a random shift,
//   become VPLs, so that any state has the same chance. Repeats of a state become one VPL.
// - There is one try per step instead of several: a try costs as much as a step, and every step gives a state
//   to choose from. Measured with two tries, nothing is gained at equal cost or at twice the cost
//   (bench/log/samplers.md).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/base/random.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

// Chosen by RMSE at 1000 VPLs with a clamp radius of 2.5 % of the range, on scenes/cornell-box and in a large
// hall. Seeds / chains / steps of 8/4/4 give 0.0077 and 0.036, 8/4/2 0.0077 and 0.035, 4/2/8 0.0075 and
// 0.036, 8/2/4 0.0084 and 0.037. With only as many states as VPLs, the RMSE is 0.0093 to 0.0102 and 0.037 to
// 0.040, whatever the steps between them: it matters to have several states per VPL to choose from.
constexpr double kSeedsPerVpl = 8;
constexpr double kChainsPerVpl = 4;
constexpr uint kStepsPerChain = 4;
/// The share of the mean target that follows power alone. It bounds the power of VPLs that the estimate
/// misses.
constexpr double kMetropolisBlindShare = 0.1;

constexpr uint kPilotSeeds = 2048;
constexpr uint kMinSeeds = 2048;
constexpr uint kMaxSeeds = 1u << 21u;
constexpr uint kMaxPairs = 1u << 23u;  ///< pairs of numbers in one buffer, 64 MiB
constexpr uint kMetropolisPilotSeed = 0x3e7f0u;
constexpr std::uint64_t kStarts = 0x57a7;
constexpr std::uint64_t kThinning = 0x7415;

struct Seeds {
    Buffer<Vpl> vpls;
    std::vector<float> targets;
    double mean_target = 0;
};

uint max_in_step(uint bounce_count) {
    return std::max(kMaxPairs / walk_pair_count(bounce_count), 64u);
}

Seeds make_seeds(SamplerStages& stages, const PathSpace& space, uint count) {
    Seeds seeds{.vpls = Buffer<Vpl>(stages.device, count), .targets = std::vector<float>(count)};
    const uint batch = std::min(count, max_in_step(space.bounce_count));
    for (uint first = 0; first < count; first += batch) {
        PathStates states(stages.device, std::min(batch, count - first), space.bounce_count);
        std::vector<uint> indices(states.count);
        std::iota(indices.begin(), indices.end(), first);
        stages.metropolis_chains().seed(space, Buffer<uint>(stages.device, std::span<const uint>(indices)),
                                        states);
        states.targets.download(std::span(seeds.targets).subspan(first, states.count));
        seeds.vpls.upload(states.vpls.download(), first);
    }
    seeds.mean_target = std::accumulate(seeds.targets.begin(), seeds.targets.end(), 0.0) / count;
    return seeds;
}

/// Chooses the blind target that makes kMetropolisBlindShare of the mean target.
float choose_blind_target(SamplerStages& stages, PathSpace& space) {
    space.blind_target = 0.0f;
    const Seeds pilot = make_seeds(stages, space, kPilotSeeds);
    double power = 0;
    for (const Vpl& vpl : pilot.vpls.download()) {
        power += luminance(vpl.power) / kPilotSeeds;
    }
    const double target = kMetropolisBlindShare / (1 - kMetropolisBlindShare) * pilot.mean_target / power;
    // Where nothing lit is in view, power alone counts.
    return target > 0 && target < 1e30 ? static_cast<float>(target) : 1.0f;
}

/// Chooses `count` indices of seeds along the Morton curve. Seed i is expected count · target_i / Σ target
/// times.
std::vector<uint> choose_starts(SamplerStages& stages, const Seeds& seeds, std::size_t count, double shift) {
    Buffer<uint> order(stages.device, seeds.targets.size());
    stages.morton_sort.order(seeds.vpls, seeds.targets.size(), order);
    const double per_target =
        static_cast<double>(count) / (seeds.mean_target * static_cast<double>(seeds.targets.size()));
    std::vector<uint> starts;
    double sum = shift;
    for (const uint index : order.download()) {
        sum += seeds.targets[index] * per_target;
        starts.resize(std::min<std::size_t>(count, static_cast<std::size_t>(sum)), index);
    }
    return starts;
}

/// Returns all states of all chains along the Morton curve. Each carries its share of the light.
std::vector<Vpl> run_chains(SamplerStages& stages, const PathSpace& space, const Seeds& seeds,
                            const std::vector<uint>& starts, uint steps) {
    PathStates chains(stages.device, starts.size(), space.bounce_count);
    PathStates proposed(stages.device, starts.size(), space.bounce_count);
    const std::size_t state_count = starts.size() * steps;
    const auto scale = static_cast<float>(seeds.mean_target / static_cast<double>(state_count));
    Buffer<Vpl> states(stages.device, state_count);
    Buffer<Vpl> sorted(stages.device, state_count);
    Buffer<uint> order(stages.device, state_count);
    stages.metropolis_chains().seed(space, Buffer<uint>(stages.device, std::span(starts)), chains);
    for (uint step = 0; step < steps; ++step) {
        stages.metropolis_chains().advance(space, step, chains, proposed);
        stages.metropolis_chains().keep(chains, scale, states, step * starts.size());
    }
    stages.morton_sort.order(states, state_count, order);
    stages.compaction.gather(states, order, state_count, sorted);
    return sorted.download();
}

/// Picks about `wanted` states at even distances, which get the power of all. Neighbours that are the same
/// state become one VPL.
std::vector<Vpl> thin(const std::vector<Vpl>& states, uint wanted, double shift) {
    const std::vector<float> weights(states.size(), 1.0f);
    const Choice choice = resample(weights, wanted, shift);
    std::vector<Vpl> thinned;
    for (const Vpl& vpl : take(choice, states)) {
        if (!thinned.empty() && thinned.back().depth == vpl.depth &&
            is_zero(thinned.back().position - vpl.position)) {
            thinned.back().power += vpl.power;
        } else {
            thinned.push_back(vpl);
        }
    }
    return thinned;
}

}  // namespace

VplSet sample_metropolis(SamplerStages& stages, const SamplingTask& task) {
    PathSpace space{.scene = task.scene,
                    .view = task.view,
                    .clamp_radius = task.clamp_radius,
                    .seed = task.seed ^ kMetropolisPilotSeed,
                    .bounce_count = task.bounce_count,
                    .aim = walk_aim(task),
                    .depth_cdf = make_depth_cdf(stages.device, task.bounce_count, task.scene.mean_albedo)};
    space.blind_target = choose_blind_target(stages, space);
    space.seed = task.seed;
    const double seed_count = std::clamp<double>(kSeedsPerVpl * task.vpl_count, kMinSeeds, kMaxSeeds);
    const Seeds seeds = make_seeds(stages, space, static_cast<uint>(seed_count));
    if (!(seeds.mean_target > 0.0)) {
        return {.vpls = VplBuffer(stages.device, {})};
    }
    const auto chain_count = static_cast<std::size_t>(
        std::min<double>(kChainsPerVpl * task.vpl_count, max_in_step(task.bounce_count)));
    const std::vector<uint> starts =
        choose_starts(stages, seeds, chain_count, Pcg32(task.seed, kStarts).uniform());
    const double steps_needed = std::ceil(2.0 * task.vpl_count / static_cast<double>(chain_count));
    // There are more steps if memory bounds the number of chains.
    const uint steps = std::max(kStepsPerChain, static_cast<uint>(steps_needed));
    const std::vector<Vpl> states = run_chains(stages, space, seeds, starts, steps);
    VplSet set;
    set.vpls = stages.vpl_order.sort(thin(states, task.vpl_count, Pcg32(task.seed, kThinning).uniform()));
    set.distant_count = set.vpls.count();
    set.candidate_count = seeds.targets.size() + states.size();
    return set;
}

}  // namespace nearlight::core
