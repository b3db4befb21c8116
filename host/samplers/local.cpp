// SPDX-License-Identifier: Apache-2.0
// Global and local virtual lights [Davidovič et al., Combining Global and Local Virtual Lights for Detailed
// Glossy Illumination, SIGGRAPH Asia 2010]: VPLs of light walks are gathered with a wide clamp radius, which
// makes their light smooth, and local lights of each tile supply what that takes away
// (kernels/local_lights.cl has the mathematics).
//
// The wide clamp follows the distance between VPLs: it is narrower where much light falls, since many VPLs
// lie there. With a single clamp radius, light from a small bright place (the inside of a lamp shade) would
// come from the few short rays that find it: on scenes/desk with 1000 and 4000 VPLs, the RMSE is 0.156 and
// 0.154 that way, and 0.050 and 0.025 this way. The clamp radius is a function of the VPL's place that does
// not depend on the VPLs, so there is no bias.
//
// Unlike in the original, global VPLs are summed one by one instead of being clustered by visibility, and
// tiles are those of the gather (8 × 8 pixels of one camera sample). As in the original, some of the global
// VPLs light a local light; but the wide clamp takes light away there too, and short paths supply it. So the
// sum has the expectation that every other sampler has, at any clamp radius.
#include <cmath>

#include "host/base/math.h"
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight::core {
namespace {

/// The wide clamp radius as a multiple of the user's, or, if that is 0, as a part of the range.
constexpr float kGatherToClampRadius = 6.0f;
constexpr float kGatherRadiusToRange = 0.15f;
/// How many VPLs of depth 1 may be expected within the radius that a VPL is gathered with, before this is
/// made narrower.
constexpr float kVplsInGatherRadius = 8.0f;
constexpr uint kRaysPerReceiver = 2;
constexpr uint kConnections = 32;
constexpr uint kDirectSamples = 2;
constexpr uint kLocalSeed = 0x10ca1u;

}  // namespace

VplSet sample_local(SamplerStages& stages, const SamplingTask& task) {
    const Deposits deposits =
        trace_about(stages, task, empty_region(stages, task.scene), KeepDeposits::all, task.vpl_count);
    const float widest = task.clamp_radius > 0.0f ? kGatherToClampRadius * task.clamp_radius
                                                  : kGatherRadiusToRange * task.close_range.range;
    // A square metre with the irradiance E has E · walks / Φ deposits of depth 1, where Φ is the power of all
    // lights.
    const float walks_per_watt = static_cast<float>(deposits.walk_count) / task.scene.total_power;
    VplSet set;
    set.vpls = stages.vpl_order.sort(deposits.vpls);
    set.distant_count = set.vpls.count();
    set.local =
        LocalLightPlan{.clamp_radius = task.clamp_radius,
                       .max_radius = widest,
                       .radius_at_unit_light = std::sqrt(kVplsInGatherRadius / (kPi * walks_per_watt)),
                       .rays_per_receiver = kRaysPerReceiver,
                       .connections = kConnections,
                       .direct_samples = kDirectSamples,
                       .bounce_count = task.bounce_count,
                       .seed = task.seed ^ kLocalSeed};
    return set;
}

}  // namespace nearlight::core
