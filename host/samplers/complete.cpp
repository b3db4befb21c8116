// SPDX-License-Identifier: Apache-2.0
// The policy `complete` of close-range sampling, which goes beyond the paper:
//
// Candidates. There are several times as many as wanted VPLs: points spread evenly over the close range
// [paper §3], whether light reaches them or not, and deposits of light walks over the whole scene. The noise
// of the deposits stays in the picture however well VPLs are chosen among them, and deposits cost little
// compared with the rays that weigh them. So there are hundreds of them per VPL, and a few importons screen
// them first: they pass with a probability that follows the error they would leave, and are divided by it.
//
// Shares. Patches and deposits must not both carry the whole light of the close range. At a point y there,
// patches have the density p_patch = points / area, and deposits the density p_walk ≈ E(y) · n / Φ, where
// n deposits are expected in the close range, at which Φ watts arrive by the patches' rough light. The
// balance heuristic [Veach & Guibas 1995] shares the light between them: w_patch = p_patch / (p_patch +
// p_walk), w_walk = 1 − w_patch. So patches take over where little light falls on much surface, which
// removes the strong deposits beside the camera. Deposits remain where much light falls on little surface
// (a lamp's shade), which patches would miss or turn into outliers. Outside the close range, deposits
// carry all the light. The shares follow a rough estimate of E(y): a few samples of direct light, a gather
// from a small sparse set, one short path, and a constant, so that no lit point is taken for dark. The
// estimate need not be right for the shares to add up to 1 in expectation: at y it has the same
// distribution for a patch and for a deposit, and it is independent of both and of the light that the
// patch carries in the end.
//
// Choice. VPLs are drawn from all candidates in proportion to the error that each would leave in the picture
// (GroupContribution::errors), so that together they bring to each of several dozen parts of the picture what
// all candidates would (balanced_choice.h). The split between close and distant VPLs follows from that. The
// power of each VPL is divided by the probability that it was drawn with, so there is no bias.
//
// Cuts. Where pixels ask about few VPLs of a large set, the deposits that pass the screening are the set.
// There are so many of them that none is strong and that neighbours are alike, which is what patches and the
// choice are for; and each bundle of receivers makes a choice of its own, which is better than one for the
// picture.
//
// Light. The chosen patches get their light of all depths in full: many direct samples, a gather from a
// larger sparse set, and short paths for what the bounded gather leaves out. This sparse set is a draw among
// the deposits that are candidates too, which leaves no bias: the choice keeps the expectation of any sum
// over the candidates, whatever light they are given, and their shares do not depend on the deposits.
#include "host/samplers/complete.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "host/base/math.h"
#include "host/base/message.h"
#include "host/base/random.h"
#include "host/samplers/candidates.h"
#include "host/samplers/close_fraction.h"
#include "host/samplers/incident_light.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sparse_walks.h"
#include "host/stages/close_range.h"

namespace nearlight::core {
namespace {

// bench/log/generation.md says what was tried, and on which views.
constexpr uint kPointsPerVpl = 2;  ///< points in the close range, which have two sides each
constexpr uint kDepositsPerVpl = 256;
constexpr uint kScreenedPerVpl = 10;  ///< deposits that pass the screening
constexpr uint kDepositsPerVplOfCuts = 4;
/// The maximum number of deposits. For more VPLs than it allows, there are fewer deposits per VPL.
constexpr uint kMaxDeposits = 1u << 22u;
constexpr uint kRoughSparseVpls = 128;
constexpr IncidentQuality kRough{.direct_samples = 4, .paths = 1};
constexpr IncidentQuality kFull{.direct_samples = 64, .paths = 4};
/// The constant part of rough irradiance, as a part of what is usual on the patches.
constexpr double kAmbientShare = 0.3;
/// The weight of the error that a VPL leaves in its own neighbourhood if that is in view and faces the VPL.
/// Importons are too few to lie in every neighbourhood.
constexpr double kNeighbourhoodFloor = 0.1;
/// The most that these errors may be together, as a part of the errors that all VPLs leave in view. They do
/// not know what hides a VPL, so that without a bound a sunlit plain behind the walls of a room would take
/// nearly all draws.
constexpr double kMaxNeighbourhoodPart = 0.2;
constexpr uint kRoughSeed = 0x20060u;
constexpr uint kChoiceStream = 0x5e1ec7u;
constexpr uint kDistantChoiceStream = 0x5e1ec8u;
constexpr uint kScreeningStream = 0x5c4ee7u;

struct Candidates {
    std::vector<Vpl> vpls;  ///< patches, which have no light yet, then screened deposits
    std::size_t patch_count = 0;
    double patch_density = 0;      ///< points / m²
    double expected_deposits = 0;  ///< number of close deposits to expect before the screening
    SparseSet sparse;              ///< a sparse set of the deposits, for the light of the chosen patches
};

/// The error that a VPL of 1 W leaves around it, in the measure of GroupContribution::errors. It counts those
/// of the picture's `importon_count` importons (the picture spans about a steradian) that lie within the
/// clamp radius, each with the bounded geometry term.
double neighbourhood_error(const SamplingTask& task, Vec3 position, std::size_t importon_count) {
    const double radius = std::max<double>(task.clamp_radius, 1e-3 * task.close_range.range);
    const double distance = length(position - task.close_range.origin);
    const double seen = std::min(1.0, M_PI * radius * radius / (distance * distance));
    return std::sqrt(seen * static_cast<double>(importon_count)) / (M_PI * M_PI * radius * radius);
}

/// Adds to the weights of VPLs the error that each would leave around it.
void add_neighbourhood_errors(const SamplingTask& task, std::span<const Vpl> lit, std::size_t importon_count,
                              std::span<float> weights) {
    std::vector<double> errors(lit.size(), 0.0);
    for (std::size_t i = 0; i < lit.size(); ++i) {
        // VPLs beyond the range count too, even if only their neighbourhood is in view.
        if (in_frustum(task.close_range, lit[i].position, task.clamp_radius)) {
            const double error = neighbourhood_error(task, lit[i].position, importon_count);
            errors[i] = kNeighbourhoodFloor * error * luminance(lit[i].power);
        }
    }
    const double in_view = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double around = std::accumulate(errors.begin(), errors.end(), 0.0);
    const bool is_bounded = in_view > 0.0 && around > kMaxNeighbourhoodPart * in_view;
    const double scale = is_bounded ? kMaxNeighbourhoodPart * in_view / around : 1.0;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        weights[i] += static_cast<float>(scale * errors[i]);
    }
}

/// The number of deposits to trace, which is bounded but at least the number of VPLs.
uint deposit_count(const SamplingTask& task) {
    const uint per_vpl = task.for_cuts ? kDepositsPerVplOfCuts : kDepositsPerVpl;
    const uint ample = std::min(kMaxDeposits / per_vpl, task.vpl_count) * per_vpl;
    return std::max(task.vpl_count, ample);
}

/// Deposits in their order along the Morton curve, and the weights in proportion to which they are screened.
struct WeighedDeposits {
    std::vector<Vpl> vpls;
    std::vector<float> weights;
};

WeighedDeposits weigh_deposits(SamplerStages& stages, const SamplingTask& task,
                               std::span<const Vpl> deposits) {
    WeighedDeposits weighed{.vpls = stages.vpl_order.sorted(deposits), .weights = {}};
    weighed.weights = choice_weights(stages, task, weighed.vpls, ContributionNorm::error_of_draw);
    add_neighbourhood_errors(task, weighed.vpls, task.view.few_squared_importons.count, weighed.weights);
    return weighed;
}

/// Returns about `wanted` deposits that pass the screening, in their order along the Morton curve.
std::vector<Vpl> screened(const SamplingTask& task, const WeighedDeposits& deposits, std::size_t wanted) {
    Pcg32 random(task.seed, kScreeningStream);
    return take(resample(deposits.weights, wanted, random.uniform()), deposits.vpls);
}

Candidates make_candidates(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface) {
    Candidates candidates;
    if (!surface.empty()) {
        const std::size_t points = std::size_t{task.vpl_count} * kPointsPerVpl;
        candidates.vpls = surface.place(points, task.seed);
        candidates.patch_density = static_cast<double>(points) / surface.area();
    }
    candidates.patch_count = candidates.vpls.size();
    const Deposits deposits =
        trace_about(stages, task, surface.region(), KeepDeposits::all, deposit_count(task));
    candidates.expected_deposits = deposits.expected_close;
    const WeighedDeposits weighed = weigh_deposits(stages, task, deposits.vpls);
    const std::vector<Vpl> passed = screened(task, weighed, std::size_t{task.vpl_count} * kScreenedPerVpl);
    candidates.vpls.insert(candidates.vpls.end(), passed.begin(), passed.end());
    candidates.sparse =
        draw_sparse_set(stages, task, weighed.vpls, weighed.weights, task.vpl_count, task.seed);
    return candidates;
}

/// The number of close deposits to expect for each watt that arrives in the close range. The patches' rough
/// light tells how much arrives. It does not follow from the power of the lights, since most of the sky's may
/// arrive elsewhere.
double deposits_per_watt(const Candidates& candidates, std::span<const Vec3> rough_light) {
    double sum = 0.0;
    for (std::size_t i = 0; i < candidates.patch_count; ++i) {
        sum += luminance(rough_light[i]);
    }
    return sum > 0.0 ? candidates.expected_deposits * candidates.patch_density / sum : 0.0;
}

/// The share of the light that each candidate carries: w_patch or w_walk, and 1 outside the close range.
std::vector<float> shares(const Candidates& candidates, std::span<const Vec3> rough_light) {
    const double per_watt = deposits_per_watt(candidates, rough_light);
    std::vector<float> result(candidates.vpls.size(), 1.0f);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double walk_density = per_watt * luminance(rough_light[i]);
        const auto of_patch =
            static_cast<float>(candidates.patch_density / (candidates.patch_density + walk_density));
        if (i < candidates.patch_count) {
            result[i] = of_patch;
        } else if (is_close(candidates.vpls[i])) {
            result[i] = 1.0f - of_patch;
        }
    }
    return result;
}

/// Draws task.vpl_count candidates. Close and distant candidates are drawn separately if the user gave the
/// split.
Choice choose(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> lit) {
    auto [weights, rows] = judge(stages, task, lit);
    add_neighbourhood_errors(task, lit, task.view.importon_groups.importon_count, weights);
    if (!task.close_fraction) {
        return choose_balanced(stages, task, lit, rows, weights, task.vpl_count,
                               Pcg32(task.seed, kChoiceStream));
    }
    const std::size_t close_count = close_vpl_count(*task.close_fraction, task.vpl_count);
    std::vector<float> close_weights(weights.size());
    std::vector<float> distant_weights(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        (is_close(lit[i]) ? close_weights : distant_weights)[i] = weights[i];
    }
    // Each side gets at least one VPL, because its light would be lost otherwise.
    const Choice close =
        choose_balanced(stages, task, lit, rows, close_weights, std::max<std::size_t>(close_count, 1),
                        Pcg32(task.seed, kChoiceStream));
    const Choice distant = choose_balanced(stages, task, lit, rows, distant_weights,
                                           std::max<std::size_t>(task.vpl_count - close_count, 1),
                                           Pcg32(task.seed, kDistantChoiceStream));
    // Patches come first among the candidates, so they must come first among the chosen too.
    std::vector<std::pair<uint, float>> merged;
    for (const Choice& part : {close, distant}) {
        for (std::size_t i = 0; i < part.indices.size(); ++i) {
            merged.emplace_back(part.indices[i], part.factors[i]);
        }
    }
    std::ranges::sort(merged);
    Choice all;
    for (const auto& [index, factor] : merged) {
        all.indices.push_back(index);
        all.factors.push_back(factor);
    }
    return all;
}

/// Returns the chosen VPLs. The patches among them come first and have no light yet.
std::vector<Vpl> chosen_vpls(const Candidates& candidates, std::span<const float> share,
                             const Choice& choice) {
    std::vector<Vpl> vpls = take(choice, candidates.vpls);
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        vpls[i].power = vpls[i].power * share[choice.indices[i]];
    }
    return vpls;
}

/// What is usual of irradiances: the square of the mean root of their luminances. The few bright ones, in the
/// sun or beside a lamp, weigh less in it than in the mean.
double usual_luminance(std::span<const Vec3> irradiances) {
    double roots = 0;
    for (const Vec3 e : irradiances) {
        roots += std::sqrt(luminance(e));
    }
    const double root = roots / static_cast<double>(std::max<std::size_t>(irradiances.size(), 1));
    return root * root;
}

/// Estimates the irradiance at each candidate of the close range roughly, and never as 0. Elsewhere it is not
/// needed, and is 0.
std::vector<Vec3> rough_light(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                              const Candidates& all) {
    const std::span candidates(all.vpls);
    std::vector<Vpl> close;
    std::ranges::copy_if(candidates, std::back_inserter(close), is_close);
    const std::vector<Vec3> arriving =
        incident_light_at(stages, task, sparse, close, kRough, task.seed ^ kRoughSeed);
    const double usual = usual_luminance(std::span(arriving).first(all.patch_count));
    // Where no patch seems lit, the mean that the lights would give to all surfaces stands in.
    const double mean = task.scene.total_power / task.scene.total_area;
    const auto ambient = static_cast<float>(kAmbientShare * (usual > 0 ? usual : mean));
    std::vector<Vec3> light(candidates.size());
    auto next = arriving.begin();
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (is_close(candidates[i])) {
            light[i] = *next++ + Vec3{ambient, ambient, ambient};
        }
    }
    return light;
}

/// Returns the candidates with the power that rough light gives them, for the choice among them.
std::vector<Vpl> roughly_lit(const Candidates& candidates, std::span<const Vec3> light,
                             std::span<const float> share) {
    std::vector<Vpl> lit = candidates.vpls;
    illuminate(std::span(lit).first(candidates.patch_count), light);
    for (std::size_t i = 0; i < lit.size(); ++i) {
        lit[i].power *= share[i];
    }
    return lit;
}

/// Counts the close and the distant ones of a set's VPLs.
void count_close(std::span<const Vpl> vpls, VplSet& set) {
    set.close_count = static_cast<std::size_t>(std::ranges::count_if(vpls, is_close));
    set.distant_count = vpls.size() - set.close_count;
    set.close_fraction =
        static_cast<float>(set.close_count) / static_cast<float>(std::max<std::size_t>(vpls.size(), 1));
}

VplSet sample_for_cuts(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region) {
    const std::vector<Vpl> deposits =
        trace_about(stages, task, region, KeepDeposits::all, deposit_count(task)).vpls;
    const std::vector<Vpl> vpls = screened(task, weigh_deposits(stages, task, deposits), task.vpl_count);
    VplSet set;
    set.vpls = VplBuffer(stages.device, vpls);
    count_close(vpls, set);
    set.candidate_count = deposits.size();
    return set;
}

}  // namespace

VplSet sample_complete(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface) {
    if (task.for_cuts) {
        return sample_for_cuts(stages, task, surface.region());
    }
    if (surface.empty()) {
        say_warning("nothing is in the close range; all VPLs come from light walks");
    }
    const Candidates candidates = make_candidates(stages, task, surface);
    const SparseSet rough_sparse = trace_sparse_set(stages, task, kRoughSparseVpls, task.seed ^ kRoughSeed);
    const std::vector<Vec3> rough = rough_light(stages, task, rough_sparse, candidates);
    const std::vector<float> share = shares(candidates, rough);
    const std::vector<Vpl> lit = roughly_lit(candidates, rough, share);
    const Choice choice = choose(stages, task, lit);

    std::vector<Vpl> vpls = chosen_vpls(candidates, share, choice);
    const auto patch_count = static_cast<std::size_t>(
        std::ranges::lower_bound(choice.indices, static_cast<uint>(candidates.patch_count)) -
        choice.indices.begin());
    const std::span patches = std::span(vpls).first(patch_count);
    illuminate(patches, incident_light_at(stages, task, candidates.sparse, patches, kFull, task.seed));
    VplSet set;
    set.vpls = stages.vpl_order.sort(vpls);
    count_close(vpls, set);
    set.sparse_count = candidates.sparse.vpls.count() + rough_sparse.vpls.count();
    set.candidate_count = candidates.vpls.size();
    return set;
}

}  // namespace nearlight::core
