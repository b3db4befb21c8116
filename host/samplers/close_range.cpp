// SPDX-License-Identifier: Apache-2.0
// Close-range VPL sampling [paper §3] by the policies `paper` and `partition`: VPLs with direct light are
// spread evenly over the lit surfaces of the close range, and sparse light walks supply the other light.
// docs/method.md says where and why the paper's text had to be corrected. The policy `complete` is in
// complete.cpp.
#include <algorithm>
#include <cmath>

#include "host/base/message.h"
#include "host/base/receivers.h"
#include "host/samplers/close_fraction.h"
#include "host/samplers/close_surface.h"
#include "host/samplers/complete.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

/// Samples per patch for area and environment lights. The power of a patch follows its irradiance, noise
/// included.
constexpr uint kDirectSamplesPerPatch = 64;
/// The number of points that the pilot places to measure which share of them becomes VPLs.
constexpr uint kPilotPoints = 4096;
/// The maximum number of points per wanted VPL. It bounds the time if hardly any point of the selected
/// triangles is lit and in view.
constexpr double kMaxPointsPerVpl = 64;
constexpr uint kCloseRangePilotSeed = 0x717e5u;

/// Step 6 of the paper: makes VPLs on `point_count` points with the direct light there. Points in the dark
/// give no VPL.
std::vector<Vpl> lit_patches(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface,
                             std::size_t point_count, uint seed) {
    const std::vector<Vpl> dark = surface.place(point_count, seed);
    const std::size_t packets = receiver_packet_count(dark.size());
    Buffer<Vpl> vpls(stages.device, std::span<const Vpl>(dark));
    Buffer<ReceiverPacket> receivers(stages.device, packets);
    Buffer<IrradiancePacket> irradiance(stages.device, packets);
    stages.vpl_light.make_receivers(vpls, dark.size(), VplSide::receives, receivers);
    Buffer<IrradiancePacket> indirect(stages.device, packets);
    stages.receiver_paths.run(
        {task.scene, receivers, packets, {.light_samples = kDirectSamplesPerPatch, .seed = seed}}, irradiance,
        indirect);
    stages.vpl_light.apply(irradiance, dark.size(), vpls);
    std::vector<Vpl> lit = vpls.download();
    std::erase_if(lit, [](const Vpl& vpl) { return is_zero(vpl.power); });
    for (Vpl& vpl : lit) {
        vpl.depth = 1;
    }
    return lit;
}

/// Makes about `wanted` patch VPLs. Points in the shade, out of view or beyond the range give none, so an
/// independent pilot measures how many points that takes; to stop at a number of VPLs would bring bias.
std::vector<Vpl> place_about(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface,
                             uint wanted) {
    if (wanted == 0) {
        return {};
    }
    const std::size_t pilot =
        lit_patches(stages, task, surface, kPilotPoints, task.seed ^ kCloseRangePilotSeed).size();
    const double vpls_per_point = std::max(static_cast<double>(pilot) / kPilotPoints, 1.0 / kMaxPointsPerVpl);
    const auto points = static_cast<std::size_t>(std::clamp(std::round(wanted / vpls_per_point), 1.0, 1e8));
    return lit_patches(stages, task, surface, points, task.seed);
}

VplSet sample_with_direct_patches(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface) {
    VplSet set;
    set.close_fraction =
        task.close_fraction ? *task.close_fraction : choose_close_fraction(stages, task, surface.region());
    const uint close_budget = close_vpl_count(set.close_fraction, task.vpl_count);
    if (close_budget == 0) {
        return sample_instant_radiosity(stages, task);
    }
    std::vector<Vpl> vpls = place_about(stages, task, surface, close_budget);
    set.close_count = vpls.size();
    // At least one VPL is wanted of walks, because distant light would be lost without any.
    const uint distant_budget = std::max(task.vpl_count - close_budget, 1u);
    const std::vector<Vpl> distant =
        trace_about(stages, task, surface.region(), deposits_to_keep(task.policy), distant_budget).vpls;
    set.distant_count = distant.size();
    vpls.insert(vpls.end(), distant.begin(), distant.end());
    set.vpls = stages.vpl_order.sort(vpls);
    return set;
}

}  // namespace

VplSet sample_close_range(SamplerStages& stages, const SamplingTask& task) {
    const bool complete = task.policy == Policy::complete;
    CloseSurface surface(stages, task,
                         {.only_lit = !complete, .whole_triangles = task.policy == Policy::paper});
    if (complete) {
        return sample_complete(stages, task, surface);
    }
    if (surface.empty()) {
        say_warning("nothing that light reaches is in the close range; all VPLs come from light walks");
        return sample_instant_radiosity(stages, task);
    }
    return sample_with_direct_patches(stages, task, surface);
}

}  // namespace nearlight::core
