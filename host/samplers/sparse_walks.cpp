// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sparse_walks.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

constexpr uint kWalkCountPilotWalks = 512;
/// The maximum number of walks per wanted VPL, which bounds the time if hardly any walk lands, such as those
/// of a light that shines past the scene; and the maximum in all if none of the pilot's does, as in a scene
/// of metal and glass alone.
constexpr uint kMaxWalksPerVpl = 256;
constexpr double kMaxWalksIfNoneLands = 1 << 18;
constexpr uint kWalkCountPilotSeed = 0x9107u;

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
    WalkAim aim{.center = task.close_range.origin,
                .radius = task.close_range.range,
                .openings = {},
                .opening_count = static_cast<uint>(task.openings.size())};
    std::ranges::copy(task.openings, aim.openings);
    return aim;
}

Deposits trace_about(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region,
                     KeepDeposits keep, uint wanted) {
    if (wanted == 0) {
        return {};
    }
    LightWalks walks{.walk_count = kWalkCountPilotWalks,
                     .bounce_count = task.bounce_count,
                     .seed = task.seed ^ kWalkCountPilotSeed,
                     .aim = walk_aim(task)};
    const std::vector<Vpl> pilot = stages.light_tracer.run(task.scene, region, keep, walks);
    const auto deposits = static_cast<double>(pilot.size());
    const auto close_deposits = static_cast<double>(std::ranges::count_if(pilot, is_close));
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
