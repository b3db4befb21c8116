// SPDX-License-Identifier: Apache-2.0
// Bidirectional instant radiosity [Segovia et al., Bidirectional Instant Radiosity, EGSR 2006]: VPLs of light
// walks lie where light is; reverse VPLs, one step from what the camera sees, lie where light would matter.
// Of many VPLs of both kinds, few are chosen by what they bring to the camera.
//
// At y, reverse VPLs have the density n(y), summed over exactly the points that sent them
// (host/stages/reverse_vpls.h), and VPLs of W walks have about q(y) = W·E(y)/Φ, where Φ is the power of all
// lights. Unlike the original, which gives each kind one half, they are weighted with n/(n + q) and q/(n + q)
// (balance heuristic). The weights add up to 1 wherever a VPL can lie, so light is counted once. For that, E
// only has to be the same function of the place for both kinds; it is a rough estimate whose random numbers
// are hashes of the place. The power of a reverse VPL is albedo·E'·(n/(n + q))/n. E' is a thorough estimate
// of all arriving light, made for chosen VPLs only and with other random numbers than the weights. W is the
// number of launched walks, which comes from an independent pilot.
#include <algorithm>
#include <cmath>

#include "host/base/division.h"
#include "host/base/math.h"
#include "host/base/message.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/samplers/candidates.h"
#include "host/samplers/incident_light.h"
#include "host/samplers/resampling.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

/// The number of candidates of each kind: a multiple of the budget, and a minimum.
constexpr double kCandidatesPerVpl = 4;
constexpr uint kMinCandidates = 256;
constexpr std::size_t kMaxCameraPoints = 512;
/// The sparse set and the samples for the rough light of candidates, which their weights follow.
constexpr uint kReverseSparseVpls = 512;
constexpr IncidentQuality kRoughQuality{.direct_samples = 4, .paths = 2};
/// The part of the mean irradiance that is added to every reverse candidate's when VPLs are chosen.
constexpr float kMinLight = 0.1f;
/// The samples for the light of chosen reverse VPLs.
constexpr IncidentQuality kThorough{.direct_samples = 64, .paths = 8};

constexpr uint kReverseSeed = 0x4e7e45eu;
constexpr uint kRoughLightSeed = 0x20061u;
constexpr uint kPointStream = 0xca3e7au;
constexpr uint kBidirectionalChoice = 0x5e1ec8u;

uint multiple_of_budget(double factor, const SamplingTask& task) {
    return static_cast<uint>(std::min(std::round(factor * task.vpl_count), 1e8));
}

/// Chooses the points that send reverse rays: importons at even distances in the array, with a random offset.
CameraPoints choose_camera_points(SamplerStages& stages, const SamplingTask& task, uint wanted_rays) {
    const std::vector<Importon> importons = task.view.importons.importons.download();
    const std::size_t count =
        std::min({task.view.importons.count, kMaxCameraPoints, std::size_t{wanted_rays}});
    const double step = static_cast<double>(task.view.importons.count) / static_cast<double>(count);
    const double shift = Pcg32(task.seed, kPointStream).uniform();
    std::vector<Importon> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(importons[static_cast<std::size_t>((static_cast<double>(i) + shift) * step)]);
    }
    return make_camera_points(stages.device, points,
                              static_cast<uint>(divide_rounding_up(wanted_rays, count)));
}

/// VPLs of one kind along the Morton curve, and the quantities that their weights follow from.
struct ExaminedVpls {
    std::vector<Vpl> vpls;
    std::vector<Vec3> rough_light;        ///< irradiance, W/m²
    std::vector<float> reverse_density;   ///< n, 1/m²
    std::vector<float> standard_density;  ///< q, 1/m²
};

/// The quantities that the weights depend on, which are the same for both kinds of candidates.
struct Balance {
    SparseSet sparse;  ///< sparse set for the rough light
    CameraPoints points;
    float walks_per_watt = 0.0f;
};

ExaminedVpls examine(SamplerStages& stages, const SamplingTask& task, const Balance& balance,
                     std::span<const Vpl> vpls) {
    ExaminedVpls candidates;
    const VplBuffer sorted = stages.vpl_order.sort(vpls);
    candidates.vpls = sorted.download();
    candidates.rough_light = incident_light_at(stages, task, balance.sparse, candidates.vpls, kRoughQuality,
                                               task.seed ^ kRoughLightSeed);

    const std::size_t packets = receiver_packet_count(vpls.size());
    Buffer<ReceiverPacket> receivers(stages.device, packets);
    GatherSums<Importon> density(stages.device, packets);
    stages.vpl_light.make_receivers(sorted.buffer(), vpls.size(), VplSide::emits, receivers);
    stages.reverse_vpls().measure_density(task.scene, balance.points, receivers, packets, density);
    for (const Vec3 n : unpack(density.light, vpls.size())) {
        candidates.reverse_density.push_back(n.x);
    }
    for (const Vec3 e : candidates.rough_light) {
        candidates.standard_density.push_back(balance.walks_per_watt * luminance(e));
    }
    return candidates;
}

/// Weights the powers of reverse candidates, for an irradiance of 1. Where rounding makes n = 0, as if no
/// point saw the candidate, walks carry all of the light.
std::vector<Vpl> weigh_reverse(const ExaminedVpls& reverse) {
    std::vector<Vpl> vpls = reverse.vpls;
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        const float n = reverse.reverse_density[i];
        vpls[i].power *= n > 0.0f ? 1.0f / (n + reverse.standard_density[i]) : 0.0f;
    }
    return vpls;
}

std::vector<Vpl> weigh_standard(const ExaminedVpls& standard) {
    std::vector<Vpl> vpls = standard.vpls;
    for (std::size_t i = 0; i < vpls.size(); ++i) {
        const float n = standard.reverse_density[i];
        const float q = standard.standard_density[i];
        vpls[i].power *= n > 0.0f ? q / (n + q) : 1.0f;
    }
    return vpls;
}

/// Adds a part of the mean to rough light that VPLs are chosen by. Light would be lost if a point that only
/// seems dark could not be chosen.
std::vector<Vec3> never_dark(std::span<const Vec3> rough_light) {
    Vec3 sum{0, 0, 0};
    for (const Vec3 e : rough_light) {
        sum += e;
    }
    const float mean = luminance(sum) / static_cast<float>(std::max<std::size_t>(rough_light.size(), 1));
    const float least = mean > 0.0f ? kMinLight * mean : 1.0f;
    std::vector<Vec3> light(rough_light.begin(), rough_light.end());
    for (Vec3& e : light) {
        e += Vec3{least, least, least};
    }
    return light;
}

}  // namespace

VplSet sample_bidirectional(SamplerStages& stages, const SamplingTask& task) {
    if (task.view.importons.count == 0) {
        return sample_instant_radiosity(stages, task);  // there are no points to send rays from
    }
    const uint wanted = std::max(kMinCandidates, multiple_of_budget(kCandidatesPerVpl, task));
    const Deposits deposits =
        trace_about(stages, task, empty_region(stages, task.scene), KeepDeposits::all, wanted);
    const Balance balance{
        .sparse = trace_sparse_set(stages, task, kReverseSparseVpls, task.seed ^ kRoughLightSeed),
        .points = choose_camera_points(stages, task, wanted),
        .walks_per_watt = static_cast<float>(deposits.walk_count) / task.scene.total_power};

    const ExaminedVpls reverse =
        examine(stages, task, balance,
                stages.reverse_vpls().trace(task.scene, balance.points, task.seed ^ kReverseSeed));
    const std::vector<Vpl> unlit = weigh_reverse(reverse);
    std::vector<Vpl> candidates = unlit;
    illuminate(candidates, never_dark(reverse.rough_light));
    const std::vector<Vpl> standard = weigh_standard(examine(stages, task, balance, deposits.vpls));
    candidates.insert(candidates.end(), standard.begin(), standard.end());

    const Choice choice = resample(choice_weights(stages, task, candidates, ContributionNorm::mean),
                                   task.vpl_count, Pcg32(task.seed, kBidirectionalChoice).uniform());
    std::ranges::copy(unlit, candidates.begin());
    VplSet set;
    std::vector<Vpl> vpls = take(choice, candidates);
    const auto chosen_reverse = static_cast<std::size_t>(
        std::ranges::lower_bound(choice.indices, static_cast<uint>(unlit.size())) - choice.indices.begin());
    const std::span reverse_vpls = std::span(vpls).first(chosen_reverse);
    const SparseSet sparse = trace_sparse_set(stages, task, task.vpl_count, task.seed);
    illuminate(reverse_vpls, incident_light_at(stages, task, sparse, reverse_vpls, kThorough, task.seed));

    set.vpls = stages.vpl_order.sort(vpls);
    set.distant_count = vpls.size();
    set.sparse_count = balance.sparse.vpls.count() + sparse.vpls.count();
    set.candidate_count = candidates.size();
    say_debug(std::to_string(chosen_reverse) + " of " + std::to_string(vpls.size()) +
              " VPLs are reverse VPLs");
    return set;
}

}  // namespace nearlight::core
