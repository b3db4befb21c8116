// SPDX-License-Identifier: Apache-2.0
// Rejection of VPLs that bring little to the camera [Georgiev & Slusallek, Simple and Robust Iterative
// Importance Sampling of Virtual Point Lights, Eurographics 2010]: candidates come from instant radiosity,
// and a candidate whose contribution to the picture is estimated at Φ is accepted with probability p =
// min(Φ/Φv + ε, 1) and its power divided by p. So nearly all accepted VPLs bring the same contribution Φv.
//
// It differs from the original in these points:
// - The original refines Φv from frame to frame, beginning with 0. Here, an independent pilot fixes Φv and
//   the number of walks before the pass that uses them, so the pass is unbiased by itself. Powers are divided
//   by the number of launched walks, not of accepted VPLs, and the walks do not stop at a number of VPLs.
// - Φv is higher than the mean contribution, so more candidates are weighed and fewer of them kept, which
//   makes their contributions more even.
// - Decisions are not independent of each other: acceptances are equidistant in the running sum of p along
//   the Morton curve, with one random shift. Each candidate is still accepted with probability p, but their
//   number hardly varies and neighbours share it evenly. The result is unbiased for any estimate of Φ (here
//   it is a sum over the pilot view's receivers), because p is positive everywhere and the shift depends
//   neither on walks nor on the estimate.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/base/message.h"
#include "host/base/random.h"
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

// Chosen by RMSE at 1000 VPLs with a clamp radius of 2.5 % of the range. Φv of 2, 8, 16 and 32 times the mean
// contribution gives 0.0087, 0.0075, 0.0074 and 0.0072 on scenes/cornell-box, and 0.040, 0.037, 0.034 and
// 0.035 in a large hall. Independent decisions at 8 times the mean give 0.0095 on the box and 0.039 in the
// hall. Blind shares from 0.02 to 0.2 are equal within the noise.
constexpr double kWantedToMean = 16;
/// The maximum number of candidates per VPL. It bounds the work if few candidates bring anything, by a lower
/// Φv.
constexpr double kMaxCandidatesPerVpl = 32;
/// The minimum share of the VPLs that ε alone accepts. It bounds the power of VPLs that the estimate misses.
constexpr double kRejectionBlindShare = 0.1;

constexpr uint kFirstPilotWalks = 2048;
constexpr uint kEnoughPilotWalks = 32768;  ///< no further trial begins after so many walks
constexpr std::ptrdiff_t kEnoughContributors = 512;
constexpr uint kRejectionPilotSeed = 0x4e1ec7u;
constexpr std::uint64_t kDecisions = 0xacce97;

struct WeighedCandidates {
    Buffer<Vpl> vpls;  ///< along the Morton curve
    /// What each candidate would bring to the camera if it came from the only walk: its contribution times
    /// the number of launched walks.
    std::vector<float> contributions;
};

WeighedCandidates weigh_candidates(SamplerStages& stages, const SamplingTask& task, const Buffer<Vpl>& vpls,
                                   std::size_t count, uint walk_count) {
    WeighedCandidates candidates{.vpls = Buffer<Vpl>(stages.device, count), .contributions = {}};
    Buffer<uint> order(stages.device, count);
    Buffer<float> contributions(stages.device, count);
    stages.morton_sort.order(vpls, count, order);
    stages.compaction.gather(vpls, order, count, candidates.vpls);
    stages.vpl_contribution.run(task.scene, candidates.vpls, count, task.view, task.clamp_radius,
                                contributions);
    candidates.contributions = contributions.download();
    for (float& contribution : candidates.contributions) {
        contribution *= static_cast<float>(walk_count);
    }
    return candidates;
}

LightWalks light_walks(const SamplingTask& task, uint walk_count, uint seed) {
    return {.walk_count = walk_count, .bounce_count = task.bounce_count, .seed = seed, .aim = walk_aim(task)};
}

struct Pilot {
    std::vector<float> contributions;  ///< contributions to the camera, each times the walks of its trial
    uint walk_count = 0;
};

/// Makes trials of walks, each with twice as many as the trial before, until enough candidates contribute to
/// the camera.
Pilot explore(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region) {
    Pilot pilot;
    const auto contributes = [](float contribution) { return contribution > 0.0f; };
    for (uint trial = 0; pilot.walk_count < kEnoughPilotWalks; ++trial) {
        const LightWalks walks =
            light_walks(task, kFirstPilotWalks << trial, task.seed ^ (kRejectionPilotSeed + trial));
        stages.light_tracer.run(
            task.scene, region, KeepDeposits::all, walks, [&](const auto& vpls, std::size_t count) {
                const WeighedCandidates candidates =
                    weigh_candidates(stages, task, vpls, count, walks.walk_count);
                pilot.contributions.insert(pilot.contributions.end(), candidates.contributions.begin(),
                                           candidates.contributions.end());
            });
        pilot.walk_count += walks.walk_count;
        if (std::ranges::count_if(pilot.contributions, contributes) >= kEnoughContributors) {
            break;
        }
    }
    return pilot;
}

struct Acceptance {
    double wanted = 0;  ///< Φv
    double floor = 0;   ///< ε

    [[nodiscard]] double probability(double contribution) const {
        return std::min(contribution / wanted + floor, 1.0);
    }
    /// The expected number of VPLs that are accepted of candidates with these contributions.
    [[nodiscard]] double expected(const std::vector<float>& contributions) const {
        double sum = 0;
        for (const float contribution : contributions) {
            sum += probability(contribution);
        }
        return sum;
    }
};

/// Chooses Φv and ε. Returns nothing if no candidate brings anything.
std::optional<Acceptance> choose_acceptance(const std::vector<float>& contributions) {
    double total = 0;
    float min_contribution = std::numeric_limits<float>::max();
    for (const float contribution : contributions) {
        total += contribution;
        min_contribution = contribution > 0.0f ? std::min(min_contribution, contribution) : min_contribution;
    }
    if (!(total > 0.0) || !std::isfinite(total)) {
        return std::nullopt;
    }
    const auto count = static_cast<double>(contributions.size());
    constexpr double kMin = 1 / kMaxCandidatesPerVpl;
    Acceptance acceptance{.wanted = kWantedToMean * total / count};
    // With Φv below the minimum contribution, every contributing candidate is accepted, so a lower Φv would
    // change nothing.
    while (acceptance.expected(contributions) / count < (1 - kRejectionBlindShare) * kMin &&
           acceptance.wanted > min_contribution) {
        acceptance.wanted *= 0.9;
    }
    const double accepted = acceptance.expected(contributions) / count;
    acceptance.floor =
        std::max(kRejectionBlindShare / (1 - kRejectionBlindShare) * accepted, kMin - accepted);
    return acceptance;
}

/// The number of walks that leave about task.vpl_count accepted candidates, or kMaxWalks if that is less.
uint choose_walk_count(const SamplingTask& task, const Pilot& pilot, const Acceptance& acceptance) {
    const double accepted_per_walk = acceptance.expected(pilot.contributions) / pilot.walk_count;
    return static_cast<uint>(std::clamp(std::round(task.vpl_count / accepted_per_walk), 1.0, kMaxWalks));
}

}  // namespace

VplSet sample_rejection(SamplerStages& stages, const SamplingTask& task) {
    const CloseRegion region = empty_region(stages, task.scene);
    const Pilot pilot = explore(stages, task, region);
    const std::optional<Acceptance> acceptance = choose_acceptance(pilot.contributions);
    if (!acceptance) {
        say_warning("no light walk of the pilot brings anything to the camera; no VPL is rejected");
        return sample_instant_radiosity(stages, task);
    }
    VplSet set;
    std::vector<Vpl> accepted;
    // The sum of probabilities. A candidate is accepted where it passes a whole number.
    double sum = Pcg32(task.seed, kDecisions).uniform();
    const LightWalks walks = light_walks(task, choose_walk_count(task, pilot, *acceptance), task.seed);
    stages.light_tracer.run(
        task.scene, region, KeepDeposits::all, walks, [&](const auto& vpls, std::size_t count) {
            const WeighedCandidates candidates =
                weigh_candidates(stages, task, vpls, count, walks.walk_count);
            const std::vector<Vpl> batch = candidates.vpls.download();
            for (std::size_t i = 0; i < count; ++i) {
                const double probability = acceptance->probability(candidates.contributions[i]);
                const double before = std::floor(sum);
                sum += probability;
                if (std::floor(sum) > before) {
                    accepted.push_back(batch[i]);
                    accepted.back().power *= static_cast<float>(1.0 / probability);
                }
            }
            set.candidate_count += count;
        });
    set.vpls = stages.vpl_order.sort(accepted);
    set.distant_count = set.vpls.count();
    return set;
}

}  // namespace nearlight::core
