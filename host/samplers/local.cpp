// SPDX-License-Identifier: Apache-2.0
// Global and local virtual lights [Davidovič et al., Combining Global and Local Virtual Lights for Detailed
// Glossy Illumination, SIGGRAPH Asia 2010]: VPLs of light walks are gathered with a wide clamp, under which
// they are smooth, and lights of each tile of the picture supply what it takes away (kernels/local_lights.cl
// has the mathematics).
//
// Unlike the original, global VPLs are summed one by one instead of being clustered by visibility, and tiles
// are those of the gather (8 × 8 pixels of one camera sample). What falls on a local light comes from some of
// the global VPLs, as in the original; but there too the wide clamp takes light away, and short paths supply
// it. So the sum has the expectation that every other sampler has, at any width of the clamp.
#include "host/samplers/sampler.h"
#include "host/samplers/sparse_walks.h"

namespace nearlight {
namespace {

/// Of the wide clamp to the user's; where that is 0, to the close range.
constexpr float kGatherToClampRadius = 6.0f;
constexpr float kGatherRadiusToRange = 0.15f;
constexpr uint kRaysPerReceiver = 2;
constexpr uint kConnections = 32;
constexpr uint kDirectSamples = 2;
constexpr uint kLocalSeed = 0x10ca1u;

}  // namespace

VplSet sample_local(SamplerStages& stages, const SamplingTask& task) {
    VplSet set = sample_instant_radiosity(stages, task);
    const float radius = task.clamp_radius > 0.0f ? kGatherToClampRadius * task.clamp_radius
                                                  : kGatherRadiusToRange * task.close_range.range;
    set.local = LocalLightPlan{.gather_radius = radius,
                               .rays_per_receiver = kRaysPerReceiver,
                               .connections = kConnections,
                               .direct_samples = kDirectSamples,
                               .bounce_count = task.bounce_count,
                               .seed = task.seed ^ kLocalSeed};
    return set;
}

}  // namespace nearlight
