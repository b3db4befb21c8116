// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sparse_walks.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

constexpr uint kWalkCountPilotWalks = 512;
/// The maximum number of walks, per wanted VPL and in all. They bound the time if hardly any walk lands, such
/// as those of a light that shines past the scene, or if none of the pilot's does, as in a scene of metal and
/// glass alone.
constexpr uint kMaxWalksPerVpl = 256;
constexpr double kMaxWalks = 1 << 24;
constexpr double kMaxWalksIfNoneLands = 1 << 18;
constexpr uint kWalkCountPilotSeed = 0x9107u;
/// Lets some of the pilot's walks see depths at which there is still light in bright rooms.
constexpr float kPilotSurvival = 0.8f;

/// Which part of the walks should go on from each depth to the next, by the deposits of a pilot. For a given
/// number of deposits, their sum has the least variance if the walks at each depth are in proportion to the
/// root mean square of the flux that one leaves there. With the mean albedo instead, the deposits of walks
/// that stay among surfaces brighter than the mean would gain power at each bounce, and a few of them would
/// outshine all others.
float measured_survival(std::span<const Vpl> pilot, const LightWalks& walks) {
    const std::vector<float> launched = walks_at_each_depth(walks);
    std::vector<double> squares(launched.size());
    std::vector<double> counts(launched.size());
    for (const Vpl& deposit : pilot) {
        const std::size_t i = deposit.depth - 1;
        const double flux = static_cast<double>(luminance(deposit.power)) * launched[i];
        squares[i] += flux * flux;
        counts[i] += 1;
    }
    double here = 0;
    double next = 0;
    for (std::size_t i = 0; i + 1 < counts.size() && counts[i] > 0 && counts[i + 1] > 0; ++i) {
        const double weight = std::min(counts[i], counts[i + 1]);
        here += weight * squares[i] / counts[i];
        next += weight * squares[i + 1] / counts[i + 1];
    }
    return here > 0 ? static_cast<float>(std::sqrt(next / here)) : walks.survival;
}

}  // namespace

CloseRegion empty_region(SamplerStages& stages, const DeviceScene& scene) {
    const CloseRange nothing{};
    CloseRegion region;
    region.range = Buffer<CloseRange>(stages.device, std::span(&nothing, 1));
    region.triangles = Buffer<uint>(stages.device, scene.host_info.triangle_count);
    region.triangles.fill_zero();
    return region;
}

WalkAim walk_aim(const SamplingTask& task) {
    return {.center = task.close_range.origin, .radius = task.close_range.range};
}

Deposits trace_about(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region,
                     KeepDeposits keep, uint wanted) {
    if (wanted == 0) {
        return {};
    }
    LightWalks walks{.walk_count = kWalkCountPilotWalks,
                     .bounce_count = task.bounce_count,
                     .survival = kPilotSurvival,
                     .seed = task.seed ^ kWalkCountPilotSeed,
                     .aim = walk_aim(task)};
    const std::vector<Vpl> pilot = stages.light_tracer.run(task.scene, region, keep, walks);
    const std::vector<float> pilot_launched = walks_at_each_depth(walks);
    walks.survival = measured_survival(pilot, walks);
    const std::vector<float> launched = walks_at_each_depth(walks);
    // A deposit of the pilot stands for as many as there are walks that go on to its depth.
    double deposits = 0;
    double close_deposits = 0;
    for (const Vpl& deposit : pilot) {
        const double count = launched[deposit.depth - 1] / pilot_launched[deposit.depth - 1];
        deposits += count;
        close_deposits += is_close(deposit) ? count : 0.0;
    }
    const double needed = wanted / std::max(deposits / kWalkCountPilotWalks, 1.0 / kMaxWalksPerVpl);
    const double max_walks = !pilot.empty() ? kMaxWalks : kMaxWalksIfNoneLands;
    walks.walk_count = static_cast<uint>(std::clamp(std::round(needed), 1.0, max_walks));
    walks.seed = task.seed;
    // A pilot that met the close range nowhere was nearly large enough to meet it once.
    return {.vpls = stages.light_tracer.run(task.scene, region, keep, walks),
            .walk_count = walks.walk_count,
            .expected_close = std::max(1.0, close_deposits) * walks.walk_count / kWalkCountPilotWalks};
}

}  // namespace nearlight::core
