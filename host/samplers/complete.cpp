// SPDX-License-Identifier: Apache-2.0
// The policy `complete` of close-range sampling, which goes beyond the paper:
//
// Candidates, several times as many as are wanted, are points spread evenly over the close range [paper §3],
// whether light reaches them or not, and deposits of light walks over the whole scene. What the deposits
// leave of noise stays in the picture however well one chooses among them, and they cost little beside the
// rays that weigh them. So there are hundreds for each VPL, and a few importons screen them first: those that
// pass are drawn like the VPLs below, each divided by its probability.
//
// Shares. Two of a kind must not both answer for the close range. A point there is the end of a patch with
// density p_patch = points / area, and of a walk with density p_walk ≈ E(y) · walks / Φ, as each walk carries
// about the same flux. The balance heuristic [Veach & Guibas 1995] shares the light between them: w_patch =
// p_patch / (p_patch + p_walk), w_walk = 1 − w_patch. So patches take over where little light falls on much
// surface, which ends the strong deposits beside the camera, and walks remain where much light falls on
// little surface (a lamp's shade), which evenly spread patches would miss or make outliers of. Outside the
// close range walks have it all. The shares follow a rough estimate of E(y): a few samples of direct light, a
// gather from a small sparse set, one short path, and a constant, so that nothing is taken for dark that is
// not. The estimate need not be right for the shares to add up to 1 in expectation: at y it has the same
// distribution for a patch and for a walk, and it is independent of both and of the light that the patch
// carries in the end.
//
// Choice. VPLs are drawn from all candidates in proportion to the error each would leave in the picture
// (GroupContribution::errors), and those together that bring to each of several dozen parts of the
// picture what all candidates would (balanced_choice.h). The split between close and distant follows by
// itself. Each is divided by the probability that it was really chosen with: unbiased.
//
// Light. The chosen patches get their light of all depths in full: many direct samples, a gather from a
// larger sparse set, and short paths for what the bounded gather leaves out.
#include "host/samplers/complete.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/base/math.h"
#include "host/base/message.h"
#include "host/base/random.h"
#include "host/samplers/candidates.h"
#include "host/samplers/incident_light.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sparse_walks.h"
#include "host/stages/close_range.h"

namespace nearlight::core {
namespace {

// bench/log/generation.md has what was tried, and on which views.
constexpr uint kPointsPerVpl = 2;  ///< candidates on the close range; each has two sides
constexpr uint kDepositsPerVpl = 256;
constexpr uint kScreenedPerVpl = 10;  ///< candidates that remain of them
/// Deposits; where more VPLs are wanted, there is less choice.
constexpr uint kMaxDeposits = 1u << 22u;
constexpr uint kRoughSparseVpls = 128;
constexpr IncidentQuality kRough{.direct_samples = 4, .paths = 1};
constexpr IncidentQuality kFull{.direct_samples = 64, .paths = 4};
/// Rough irradiance where none is found, of the mean that the lights would give all surfaces.
constexpr float kAmbientShare = 0.3f;
/// Part of the error that a VPL makes in its own neighbourhood, if that is in view and faces it. The camera's
/// points are too few to meet every neighbourhood.
constexpr double kNeighbourhoodFloor = 0.1;
constexpr uint kRoughSeed = 0x20060u;
constexpr uint kChoiceStream = 0x5e1ec7u;
constexpr uint kDistantChoiceStream = 0x5e1ec8u;
constexpr uint kScreeningStream = 0x5c4ee7u;

bool is_close(const Vpl& vpl) {
    return (vpl.flags & NEARLIGHT_VPL_CLOSE) != 0;
}

struct Candidates {
    std::vector<Vpl> vpls;  ///< patches, without light yet, then screened deposits
    std::size_t patch_count = 0;
    double patch_density = 0;   ///< points / m²
    double walks_per_watt = 0;  ///< before the screening
};

/// What a VPL of 1 W leaves as error around it, in the measure of GroupContribution::errors: of
/// `importon_count` importons in a picture (about a steradian) those within the clamp radius, each by the
/// bounded term.
double neighbourhood_error(const SamplingTask& task, Vec3 position, std::size_t importon_count) {
    const double radius = std::max<double>(task.clamp_radius, 1e-3 * task.close_range.range);
    const double distance = length(position - task.close_range.origin);
    const double seen = std::min(1.0, M_PI * radius * radius / (distance * distance));
    return std::sqrt(seen * static_cast<double>(importon_count)) / (M_PI * M_PI * radius * radius);
}

/// Adds to the weights of VPLs the error that each would leave around it.
void add_neighbourhood_errors(const SamplingTask& task, std::span<const Vpl> lit, std::size_t importon_count,
                              std::span<float> weights) {
    for (std::size_t i = 0; i < lit.size(); ++i) {
        // Beyond the range too, and where only the neighbourhood is in view.
        if (in_frustum(task.close_range, lit[i].position, task.clamp_radius)) {
            const double error = neighbourhood_error(task, lit[i].position, importon_count);
            weights[i] += static_cast<float>(kNeighbourhoodFloor * error * luminance(lit[i].power));
        }
    }
}

/// That are traced: bounded, but never fewer than VPLs.
uint deposit_count(const SamplingTask& task) {
    const uint ample = std::min(kMaxDeposits / kDepositsPerVpl, task.vpl_count) * kDepositsPerVpl;
    return std::max(task.vpl_count, ample);
}

/// Deposits of walks over the whole scene, those that pass the screening, along the Morton curve.
std::vector<Vpl> screened_deposits(SamplerStages& stages, const SamplingTask& task,
                                   std::span<const Vpl> deposits) {
    const std::vector<Vpl> sorted = stages.vpl_order.sorted(deposits);
    std::vector<float> weights = choice_weights(stages, task, sorted, ContributionNorm::rough_mean_square);
    add_neighbourhood_errors(task, sorted, task.view.few_squared_importons.count, weights);
    Pcg32 random(task.seed, kScreeningStream);
    return take(resample(weights, std::size_t{task.vpl_count} * kScreenedPerVpl, random.uniform()), sorted);
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
    candidates.walks_per_watt = deposits.walk_count / static_cast<double>(task.scene.total_power);
    const std::vector<Vpl> screened = screened_deposits(stages, task, deposits.vpls);
    candidates.vpls.insert(candidates.vpls.end(), screened.begin(), screened.end());
    return candidates;
}

/// The part of each candidate's light that is its own.
std::vector<float> shares(const Candidates& candidates, std::span<const Vec3> rough_light) {
    std::vector<float> result(candidates.vpls.size(), 1.0f);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double walk_density = candidates.walks_per_watt * luminance(rough_light[i]);
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

/// Draws task.vpl_count candidates; close and distant ones apart where the user gave the split.
Choice choose(SamplerStages& stages, const SamplingTask& task, std::span<const Vpl> lit) {
    auto [weights, rows] = judge(stages, task, lit);
    add_neighbourhood_errors(task, lit, task.view.importon_groups.importon_count, weights);
    if (!task.close_fraction) {
        return choose_balanced(stages, task, lit, rows, weights, task.vpl_count,
                               Pcg32(task.seed, kChoiceStream));
    }
    const auto close_count =
        static_cast<std::size_t>(std::lround(*task.close_fraction * static_cast<float>(task.vpl_count)));
    std::vector<float> close(weights.size());
    std::vector<float> distant(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        (is_close(lit[i]) ? close : distant)[i] = weights[i];
    }
    // Neither side may be empty, or its light would be lost.
    const Choice choice =
        choose_balanced(stages, task, lit, rows, close, std::max<std::size_t>(close_count, 1),
                        Pcg32(task.seed, kChoiceStream));
    const Choice rest = choose_balanced(stages, task, lit, rows, distant,
                                        std::max<std::size_t>(task.vpl_count - close_count, 1),
                                        Pcg32(task.seed, kDistantChoiceStream));
    // Patches come first among the candidates, and must among the chosen.
    std::vector<std::pair<uint, float>> merged;
    for (const Choice& part : {choice, rest}) {
        for (std::size_t i = 0; i < part.indices.size(); ++i) {
            merged.emplace_back(part.indices[i], part.factors[i]);
        }
    }
    std::ranges::sort(merged);
    Choice both;
    for (const auto& [index, factor] : merged) {
        both.indices.push_back(index);
        both.factors.push_back(factor);
    }
    return both;
}

/// The chosen VPLs; the patches among them, which come first, still without light.
std::vector<Vpl> chosen_vpls(const Candidates& candidates, std::span<const float> share,
                             const Choice& choice) {
    std::vector<Vpl> vpls = take(choice, candidates.vpls);
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        vpls[i].power = vpls[i].power * share[choice.indices[i]];
    }
    return vpls;
}

/// What arrives at each candidate of the close range, roughly, and never nothing. Elsewhere nobody asks: 0.
std::vector<Vec3> rough_light(SamplerStages& stages, const SamplingTask& task, const SparseSet& sparse,
                              std::span<const Vpl> candidates) {
    std::vector<Vpl> close;
    std::ranges::copy_if(candidates, std::back_inserter(close), is_close);
    const std::vector<Vec3> arriving =
        incident_light_at(stages, task, sparse, close, kRough, task.seed ^ kRoughSeed);
    const auto ambient = static_cast<float>(kAmbientShare * task.scene.total_power / task.scene.total_area);
    std::vector<Vec3> light(candidates.size());
    auto next = arriving.begin();
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (is_close(candidates[i])) {
            light[i] = *next++ + Vec3{ambient, ambient, ambient};
        }
    }
    return light;
}

/// Candidates as they look by rough light, to choose by.
std::vector<Vpl> roughly_lit(const Candidates& candidates, std::span<const Vec3> light,
                             std::span<const float> share) {
    std::vector<Vpl> lit = candidates.vpls;
    illuminate(std::span(lit).first(candidates.patch_count), light);
    for (std::size_t i = 0; i < lit.size(); ++i) {
        lit[i].power *= share[i];
    }
    return lit;
}

}  // namespace

VplSet sample_complete(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface) {
    if (surface.empty()) {
        say_warning("nothing is in the close range; all VPLs come from light walks");
    }
    const Candidates candidates = make_candidates(stages, task, surface);
    const SparseSet rough_sparse = trace_sparse_set(stages, task, kRoughSparseVpls, task.seed ^ kRoughSeed);
    const std::vector<Vec3> rough = rough_light(stages, task, rough_sparse, candidates.vpls);
    const std::vector<float> share = shares(candidates, rough);
    const std::vector<Vpl> lit = roughly_lit(candidates, rough, share);
    const Choice choice = choose(stages, task, lit);

    std::vector<Vpl> vpls = chosen_vpls(candidates, share, choice);
    const auto patch_count = static_cast<std::size_t>(
        std::ranges::lower_bound(choice.indices, static_cast<uint>(candidates.patch_count)) -
        choice.indices.begin());
    const SparseSet sparse = trace_sparse_set(stages, task, task.vpl_count, task.seed);
    const std::span patches = std::span(vpls).first(patch_count);
    illuminate(patches, incident_light_at(stages, task, sparse, patches, kFull, task.seed));
    VplSet set;
    set.vpls = stages.vpl_order.sort(vpls);
    set.close_count = static_cast<std::size_t>(std::ranges::count_if(vpls, is_close));
    set.distant_count = vpls.size() - set.close_count;
    set.sparse_count = sparse.vpls.count() + rough_sparse.vpls.count();
    set.candidate_count = candidates.vpls.size();
    set.close_triangles = surface.triangle_count();
    set.close_fraction =
        static_cast<float>(set.close_count) / static_cast<float>(std::max<std::size_t>(vpls.size(), 1));
    return set;
}

}  // namespace nearlight::core
