// SPDX-License-Identifier: Apache-2.0
#include "host/session/ray_budget.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "host/base/division.h"
#include "host/base/message.h"
#include "host/base/receiver_bundles.h"
#include "host/base/receivers.h"

namespace nearlight::core {
namespace {

/// Candidates, as multiples of the radius that the pilot starts from. The first must be 1.
constexpr std::array kRadiusMultiples{1.0f, 0.25f, 0.5f, 2.0f, 4.0f};
constexpr std::array<uint, 4> kLightSampleNumbers{16, 32, 64, 128};
/// What a pixel costs, rays and light samples apart, and what a light sample and an aimed ray cost, in rays:
/// medians of measurements on a CPU (bench/log/limit.md). Only their order of magnitude matters.
constexpr double kPixelCost = 40;
constexpr double kLightSampleCost = 0.75;
constexpr double kAimedRayCost = 0.8;
/// Candidates of rays that a receiver aims.
constexpr std::array<uint, 3> kAimedRayNumbers{1, 4, 16};
static_assert(kAimedRayNumbers.back() <= kMaxAimedRays);
/// Cosine-distributed rays for each that aims, about as many as each sample of a pixel has.
constexpr uint kRaysOfAim = 4;
constexpr std::array<uint, 2> kRaySeeds{0x0c1a3bu, 0x7e57edu};
constexpr double kDarkPart = 0.01;  ///< of the mean light, squared: errors in the dark count less
/// Bounds of the parts of a receiver's relative squared error, before the weights below. A single ray that
/// met a lamp's reflection would otherwise decide for the whole picture.
constexpr double kMaxErrorOfVpls = 0.2;
constexpr double kMaxErrorOfRay = 16 * kMaxErrorOfVpls;  ///< and of one light sample
/// The bound of the error of rays that meet lamps over mirrors and glass, which is known better.
constexpr double kMaxErrorOfDot = 16;
/// The squared error of one draw of a cut, relative to the light of all VPLs: it is about 1 where half of
/// what is drawn is occluded (bench/log/cuts.md).
constexpr double kErrorOfDraw = 1.0;
/// The error of rays ÷ what two rays at each receiver of the pilot view show of it, which miss the rare
/// bright paths that carry most, though bundles share what rays find (bench/log/sharing.md).
constexpr double kHiddenErrorOfRays = 4;
/// How much more the error of VPLs counts than that of rays: neighbouring pixels share it, so that it is seen
/// as splotches, and a denoiser leaves it (bench/log/limit.md).
constexpr double kWeightOfSharedError = 3;

/// The part of receivers that are the brightest, which does not count in the mean radiance: rays that met a
/// lamp by chance would raise it.
constexpr double kBrightestPart = 0.01;
/// RayBudget::shared_limit ÷ the mean radiance of places. As many receivers share what one of them finds, so
/// that a find up to the limit brings to each of them about as much as it has anyway (bench/log/sharing.md).
constexpr double kSharedLimit = kBundleReceivers;

using Packets = std::vector<IrradiancePacket>;

/// The light that reaches the pilot's receivers, and how its estimate varies, for one candidate.
struct PilotLight {
    std::array<Packets, 2> direct;  ///< by a light sample and a ray, for each of kRaySeeds
    std::array<Packets, 2> rays;    ///< indirect light that one ray brings, for each of kRaySeeds
    Packets vpls;                   ///< sum of what VPLs bring
    Packets vpl_squares;            ///< sum of the squares of what each VPL brings
};

/// The VPLs of a launch of the pilot's gather, which launches groups whole, so that it is short.
std::size_t pilot_group_size(std::size_t vpl_count) {
    constexpr std::size_t kMinPilotGroup = 256;
    constexpr std::size_t kMaxPilotGroups = 64;
    return std::max(kMinPilotGroup, divide_rounding_up(vpl_count, kMaxPilotGroups));
}

/// The sum of consecutive runs of `count` packets.
Packets sum_of_groups(const Packets& groups, std::size_t count) {
    Packets sum(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = count; i < groups.size(); ++i) {
        IrradiancePacket& to = sum[i % count];
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            to.r[lane] += groups[i].r[lane];
            to.g[lane] += groups[i].g[lane];
            to.b[lane] += groups[i].b[lane];
        }
    }
    return sum;
}

PilotLight light_of(const BudgetPilot& pilot, float radius) {
    Device& device = pilot.stages.device;
    const std::size_t packets = pilot.view.packet_count;
    PilotLight light;
    Buffer<IrradiancePacket> direct(device, packets);
    Buffer<IrradiancePacket> indirect(device, packets);
    for (std::size_t i = 0; i < kRaySeeds.size(); ++i) {
        pilot.stages.receiver_paths.run({pilot.scene,
                                         pilot.view.receivers,
                                         packets,
                                         {.light_samples = 1,
                                          .rays = 1,
                                          .max_edges = pilot.max_edges,
                                          .clamp_radius = radius,
                                          .seed = pilot.seed ^ kRaySeeds[i]}},
                                        direct, indirect);
        light.direct[i] = direct.download();
        light.rays[i] = indirect.download();
    }
    const std::size_t group_size = pilot_group_size(pilot.vpls.count());
    GatherSums<Vpl> sums(device, packets, divide_rounding_up(pilot.vpls.count(), group_size));
    pilot.stages.gatherer.gather<Vpl>({.tree = pilot.scene.tree,
                                       .vpls = pilot.vpls.buffer(),
                                       .vpl_count = pilot.vpls.count(),
                                       .receivers = pilot.view.receivers,
                                       .packet_count = packets,
                                       .clamp_radius = radius,
                                       .group_size = static_cast<uint>(group_size),
                                       .curves = pilot.scene.curves_in_use(),
                                       .has_maps = pilot.scene.has_maps()},
                                      sums);
    light.vpls = sum_of_groups(sums.groups.download(), packets);
    light.vpl_squares = sums.squares.download();
    return light;
}

double sum_of(Vec3 v) {
    return double{v.x} + v.y + v.z;
}

Vec3 mean_of(const std::array<Packets, 2>& pair, std::size_t i) {
    return 0.5f * (irradiance_at(pair[0], i) + irradiance_at(pair[1], i));
}

/// The variance of one estimate of a receiver, by the difference of a pair of them.
double variance_of(const std::array<Packets, 2>& pair, std::size_t i) {
    const Vec3 change = irradiance_at(pair[0], i) - irradiance_at(pair[1], i);
    return 0.5 * dot(change, change);
}

/// The parts of a receiver's squared error, each relative to the square of its light, bounded, and weighted
/// by kHiddenErrorOfRays or kWeightOfSharedError: of one ray, of one light sample, and of all VPLs.
struct ErrorParts {
    double of_ray = 0;
    double of_light_sample = 0;
    double of_vpls = 0;
};

Vec3 light_at(const PilotLight& light, std::size_t i) {
    return mean_of(light.direct, i) + irradiance_at(light.vpls, i) + mean_of(light.rays, i);
}

float shared_limit(const PilotLight& light) {
    std::vector<double> lit;
    for (std::size_t i = 0; i < light.vpls.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        if (const double irradiance = sum_of(light_at(light, i)) / 3; irradiance > 0.0) {
            lit.push_back(irradiance);
        }
    }
    const auto count = static_cast<std::size_t>((1.0 - kBrightestPart) * static_cast<double>(lit.size()));
    if (count == 0) {
        return std::numeric_limits<float>::max();
    }
    std::ranges::sort(lit);
    const double mean = std::accumulate(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
                        static_cast<double>(count);
    return static_cast<float>(std::min(kSharedLimit * mean / std::numbers::pi, 1e38));
}

/// The square of each receiver's light, with a part of the mean's, so that errors in the dark count less.
std::vector<double> squares_of_light(const PilotLight& light) {
    std::vector<double> sums(light.vpls.size() * NEARLIGHT_PACKET_SIZE);
    double mean = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] = sum_of(light_at(light, i));
        mean += sums[i] / static_cast<double>(sums.size());
    }
    for (double& sum : sums) {
        sum = sum * sum + kDarkPart * mean * mean + 1e-30;
    }
    return sums;
}

/// The squared error that VPLs leave: that of the whole set, which is as much smaller than that of a few VPLs
/// as there are more of them, and with cuts that of the draws, too.
double error_of_vpls(const BudgetPilot& pilot, Vec3 light, Vec3 squares) {
    const double of_set =
        sum_of(squares) * static_cast<double>(pilot.vpls.count()) / static_cast<double>(pilot.set_count);
    if (pilot.asked_count == 0) {
        return of_set;
    }
    return of_set + kErrorOfDraw * dot(light, light) / static_cast<double>(pilot.asked_count);
}

std::vector<ErrorParts> error_parts(const BudgetPilot& pilot, const PilotLight& light,
                                    std::span<const double> squares) {
    std::vector<ErrorParts> parts(squares.size());
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const double of_vpls =
            error_of_vpls(pilot, irradiance_at(light.vpls, i), irradiance_at(light.vpl_squares, i));
        const double of_ray = std::min(variance_of(light.rays, i) / squares[i], kMaxErrorOfRay);
        parts[i] = {.of_ray = kHiddenErrorOfRays * of_ray,
                    .of_light_sample = std::min(variance_of(light.direct, i) / squares[i], kMaxErrorOfRay),
                    .of_vpls = kWeightOfSharedError * std::min(of_vpls / squares[i], kMaxErrorOfVpls)};
    }
    return parts;
}

/// The means over receivers.
ErrorParts mean_parts(std::span<const ErrorParts> parts) {
    ErrorParts mean;
    for (const ErrorParts& part : parts) {
        mean.of_ray += part.of_ray / static_cast<double>(parts.size());
        mean.of_light_sample += part.of_light_sample / static_cast<double>(parts.size());
        mean.of_vpls += part.of_vpls / static_cast<double>(parts.size());
    }
    return mean;
}

/// The means over receivers of what light over mirrors and glass adds to the error of a pixel.
struct MeanCausticErrors {
    double unaimed = 0;
    double aimed = 0;
};

/// The errors for so many aimed rays. Where that of a receiver without them exceeds its bound, that with them
/// is lessened in proportion, so that the bound does not hide what aiming gains.
MeanCausticErrors caustic_errors(const BudgetPilot& pilot, std::span<const double> squares, uint aimed_rays) {
    const CausticErrors errors = pilot.stages.receiver_paths.caustic_errors(
        {pilot.scene,
         pilot.view.receivers,
         pilot.view.packet_count,
         {.rays = kRaysOfAim, .aimed_rays = aimed_rays, .max_edges = pilot.max_edges, .seed = pilot.seed}});
    const double share =
        static_cast<double>(kRaysOfAim) / pilot.rays_per_pixel / static_cast<double>(squares.size());
    MeanCausticErrors mean;
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const double unaimed = double{errors.unaimed[i]} / squares[i];
        const double aimed = double{errors.aimed[i]} / squares[i];
        const double part = unaimed > kMaxErrorOfDot ? kMaxErrorOfDot / unaimed : 1.0;
        mean.unaimed += share * part * unaimed;
        mean.aimed += share * part * aimed;
    }
    return mean;
}

/// A candidate, and how much time it needs for a given error, up to a factor.
struct Candidate {
    RayBudget budget;
    double error = 0.0;
    double cost = 0.0;
    double error_times_cost = std::numeric_limits<double>::infinity();
};

/// The best number of light samples for one radius.
Candidate best_number(const ErrorParts& mean, uint rays, float radius) {
    Candidate best;
    for (const uint light_samples : kLightSampleNumbers) {
        const double error = mean.of_vpls + mean.of_ray / rays + mean.of_light_sample / light_samples;
        const double cost = kPixelCost + rays + kLightSampleCost * light_samples;
        if (error * cost < best.error_times_cost) {
            best = {{radius, light_samples}, error, cost, error * cost};
        }
    }
    return best;
}

/// How many rays receivers aim at mirrors and glass: 0 where that does not pay.
uint best_aimed_rays(const BudgetPilot& pilot, const Candidate& candidate, std::span<const double> squares) {
    uint best = 0;
    double best_value = std::numeric_limits<double>::infinity();
    for (const uint aimed_rays : kAimedRayNumbers) {
        const MeanCausticErrors caustic = caustic_errors(pilot, squares, aimed_rays);
        const double cost = kAimedRayCost * aimed_rays * pilot.rays_per_pixel / kRaysOfAim;
        const double unaimed = (candidate.error + caustic.unaimed) * candidate.cost;
        const double aimed = (candidate.error + caustic.aimed) * (candidate.cost + cost);
        say_debug("light over mirrors and glass adds an error of " + std::to_string(caustic.unaimed) +
                  ", or " + std::to_string(caustic.aimed) + " with " + std::to_string(aimed_rays) +
                  " aimed rays of a receiver");
        if (aimed < unaimed && aimed / unaimed < best_value) {
            best_value = aimed / unaimed;
            best = aimed_rays;
        }
    }
    say_debug("receivers aim " + std::to_string(best) + " rays at mirrors and glass");
    return best;
}

void say_candidate(const Candidate& candidate, const ErrorParts& mean, uint rays) {
    say_debug("clamp radius " + std::to_string(candidate.budget.clamp_radius) + ": " +
              std::to_string(candidate.budget.direct_samples_per_pixel) + " light samples, weighted error " +
              std::to_string(candidate.error) + ", by VPLs " + std::to_string(mean.of_vpls) +
              " and by rays " + std::to_string(mean.of_ray / rays));
}

}  // namespace

RayBudget choose_ray_budget(const BudgetPilot& pilot) {
    std::vector<double> squares;
    float limit = 0.0f;
    Candidate best{.budget = {.clamp_radius = pilot.clamp_radius}};
    const std::size_t radii = pilot.radius_is_open ? kRadiusMultiples.size() : 1;
    for (const float multiple : std::span(kRadiusMultiples).first(radii)) {
        const PilotLight light = light_of(pilot, multiple * pilot.clamp_radius);
        if (squares.empty()) {
            squares = squares_of_light(light);
            limit = shared_limit(light);
        }
        const ErrorParts mean = mean_parts(error_parts(pilot, light, squares));
        const Candidate candidate = best_number(mean, pilot.rays_per_pixel, multiple * pilot.clamp_radius);
        say_candidate(candidate, mean, pilot.rays_per_pixel);
        if (candidate.error_times_cost < best.error_times_cost) {
            best = candidate;
        }
    }
    best.budget.shared_limit = limit;
    if (pilot.scene.caustic_aims.table.size > 0) {
        best.budget.aimed_rays = best_aimed_rays(pilot, best, squares);
    }
    return best.budget;
}

}  // namespace nearlight::core
