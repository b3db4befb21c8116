// SPDX-License-Identifier: Apache-2.0
// The interface of all samplers, which turn a task into a set of virtual point lights. A sampler knows
// nothing of images.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>

#include "host/samplers/sampler_stages.h"
#include "host/stages/device_scene.h"
#include "host/stages/local_lights.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_buffer.h"
#include "kernels/shared/walk_aim.h"
#include "nearlight/settings.h"

namespace nearlight::core {

std::string to_string(SamplerKind kind);
std::string to_string(Policy policy);

/// The sampler, or "file" if the VPLs come from one.
std::string sampler_name(const SamplingSettings& settings);
/// The policy; nothing if the VPLs are made without one.
std::optional<std::string> policy_name(const SamplingSettings& settings);

struct SamplingTask {
    const DeviceScene& scene;
    const PilotView& view;  ///< the pilot view, a small sample of the picture's receivers
    SamplerKind sampler = SamplerKind::close_range;
    Policy policy = Policy::complete;
    uint vpl_count = 1000;  ///< target number; light walks decide the exact one
    bool for_cuts = false;  ///< whether pixels ask about few VPLs each, so that the set may be large
    uint bounce_count = 6;  ///< maximum depth of a VPL
    /// The share of vpl_count for the close range, in [0, 1]; if it is empty, a pilot chooses it.
    std::optional<float> close_fraction;
    CloseRange close_range{};
    std::span<const Opening> openings{};  ///< through which walks from outside come in
    float clamp_radius = 0.0f;            ///< R of the bounded geometry term, m
    uint seed = 0;
};

/// What a pixel spends beside the gather of VPLs, and where the VPLs end and rays begin.
struct RayBudget {
    float clamp_radius = 0.0f;  ///< m
    uint direct_samples_per_pixel = 64;
    float shared_limit = std::numeric_limits<float>::max();  ///< GatherSettings::shared_limit, W/m²/sr
    uint aimed_rays = 0;  ///< ReceiverPathSettings::aimed_rays, at mirrors and glass

    friend bool operator==(const RayBudget&, const RayBudget&) = default;
};

/// Whether a VPL lies in the close range.
inline bool is_close(const Vpl& vpl) {
    return (vpl.flags & NEARLIGHT_VPL_CLOSE) != 0;
}

/// A set of VPLs that is ready to be gathered. The powers add up to the scene's reflected flux in
/// expectation.
struct VplSet {
    VplBuffer vpls;  ///< along the Morton curve
    /// VPLs that count as those of the close range: the patches, and, with the policy `complete`, also the
    /// deposits there. The policies `partition` and `paper` count all deposits as distant.
    std::size_t close_count = 0;
    std::size_t distant_count = 0;    ///< all other VPLs
    std::size_t sparse_count = 0;     ///< VPLs of the sparse sets, which no pixel gathers
    std::size_t candidate_count = 0;  ///< candidates that `vpls` were chosen from; 0: there was no choice
    /// With cuts, the number of VPLs that a pixel asks about, which is less than all; 0: it asks about all.
    std::size_t asked_count = 0;
    float close_fraction = 0.0f;  ///< share of the VPLs for the close range that was used
    /// If it is set, VPLs are to be gathered with the plan's radii, and local lights supply the rest.
    std::optional<LocalLightPlan> local{};
    /// What is best spent beside these VPLs, if a pilot chose it.
    std::optional<RayBudget> ray_budget{};
    /// Seconds that a set like this one takes where no part of it is kept from another picture; 0: as many as
    /// it took.
    double seconds_unless_kept = 0.0;
};

/// Makes VPLs by the task's sampler. The set is empty if no VPL or bounce is wanted, or if the scene has no
/// emitter.
VplSet sample_vpls(SamplerStages& stages, const SamplingTask& task);

VplSet sample_close_range(SamplerStages& stages, const SamplingTask& task);
VplSet sample_instant_radiosity(SamplerStages& stages, const SamplingTask& task);
VplSet sample_rejection(SamplerStages& stages, const SamplingTask& task);
VplSet sample_metropolis(SamplerStages& stages, const SamplingTask& task);
VplSet sample_bidirectional(SamplerStages& stages, const SamplingTask& task);
VplSet sample_local(SamplerStages& stages, const SamplingTask& task);

/// A row of the table of samplers, from which commands take names and descriptions.
struct SamplerEntry {
    SamplerKind kind;
    const char* name;
    const char* description;  ///< a few words, for help texts
    VplSet (*sample)(SamplerStages& stages, const SamplingTask& task);
    /// Begins to compile the stages that only some samplers need; null if the sampler needs none of them.
    void (*begin_compiling)(SamplerStages& stages, Policy policy);
    bool makes_local_lights;  ///< whether it sets VplSet::local, so that pictures need local lights
};
struct PolicyEntry {
    Policy policy;
    const char* name;
    const char* description;
};
std::span<const SamplerEntry> all_samplers();
const SamplerEntry& sampler_entry(SamplerKind kind);
std::span<const PolicyEntry> all_policies();

}  // namespace nearlight::core
