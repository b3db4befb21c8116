// SPDX-License-Identifier: Apache-2.0
// The one interface of all samplers: a task in, a set of virtual point lights out. A sampler knows no images.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/samplers/sampler_stages.h"
#include "host/stages/device_scene.h"
#include "host/stages/local_lights.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_buffer.h"
#include "nearlight/settings.h"

namespace nearlight::core {

std::string to_string(SamplerKind kind);
std::string to_string(Policy policy);

struct SamplingTask {
    const DeviceScene& scene;
    const PilotView& view;  ///< a few receivers of the picture
    SamplerKind sampler = SamplerKind::close_range;
    Policy policy = Policy::complete;
    uint vpl_count = 1000;  ///< to aim at; walks decide how many there are exactly
    uint bounce_count = 6;  ///< deepest VPL
    std::optional<float>
        close_fraction;  ///< share of the budget for the close range, [0, 1]; empty: by pilot
    CloseRange close_range{};
    float clamp_radius = 0.0f;
    uint seed = 0;
};

/// Ready to be gathered: powers add up to the scene's reflected flux in expectation.
struct VplSet {
    VplBuffer vpls;                   ///< along the Morton curve
    std::size_t close_count = 0;      ///< placed on close-range patches
    std::size_t distant_count = 0;    ///< deposited by light walks
    std::size_t close_triangles = 0;  ///< triangles that patches were placed on
    std::size_t sparse_count = 0;     ///< VPLs that only lit other VPLs and are not gathered by the picture
    std::size_t candidate_count = 0;  ///< that `vpls` were chosen from; 0: there was no choice
    float close_fraction = 0.0f;      ///< that was used
    /// Where set, VPLs are to be gathered with its radius, and local lights supply the rest.
    std::optional<LocalLightPlan> local{};
};

VplSet sample_vpls(SamplerStages& stages, const SamplingTask& task);

VplSet sample_close_range(SamplerStages& stages, const SamplingTask& task);
VplSet sample_instant_radiosity(SamplerStages& stages, const SamplingTask& task);
VplSet sample_rejection(SamplerStages& stages, const SamplingTask& task);
VplSet sample_metropolis(SamplerStages& stages, const SamplingTask& task);
VplSet sample_bidirectional(SamplerStages& stages, const SamplingTask& task);
VplSet sample_local(SamplerStages& stages, const SamplingTask& task);

/// A row of the table of samplers, by which commands know them.
struct SamplerEntry {
    SamplerKind kind;
    const char* name;
    const char* description;  ///< a few words, for help texts
    VplSet (*sample)(SamplerStages& stages, const SamplingTask& task);
    /// Begins to compile the stages that only some samplers need; null: there are none.
    void (*begin_compiling)(SamplerStages& stages, Policy policy);
    bool makes_local_lights;  ///< VplSet::local is set, so rows are gathered with local lights
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
