// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sampler.h"

#include <algorithm>
#include <array>

namespace nearlight::core {
namespace {

void compile_for_close_range(SamplerStages& stages, Policy policy) {
    if (policy != Policy::complete) {
        stages.light_visibility();
    }
}
void compile_for_metropolis(SamplerStages& stages, Policy) {
    stages.metropolis_chains();
}
void compile_for_bidirectional(SamplerStages& stages, Policy) {
    stages.reverse_vpls();
}

constexpr std::array kSamplers{
    SamplerEntry{SamplerKind::close_range, "close-range",
                 "on the surfaces close to and in front of the camera, and sparsely elsewhere",
                 sample_close_range, compile_for_close_range, false},
    SamplerEntry{SamplerKind::instant_radiosity, "instant-radiosity", "wherever light walks land",
                 sample_instant_radiosity, nullptr, false},
    SamplerEntry{SamplerKind::rejection, "rejection",
                 "where light walks land, if the light there matters to the camera", sample_rejection,
                 nullptr, false},
    SamplerEntry{SamplerKind::metropolis, "metropolis",
                 "where Markov chains find light that matters to the camera", sample_metropolis,
                 compile_for_metropolis, false},
    SamplerEntry{SamplerKind::bidirectional, "bidirectional",
                 "where light walks land, and where rays from visible points land", sample_bidirectional,
                 compile_for_bidirectional, false},
    SamplerEntry{SamplerKind::local, "local",
                 "wherever light walks land, smoothed, with extra lights near each tile", sample_local,
                 nullptr, true},
};
constexpr std::array kPolicies{
    PolicyEntry{Policy::complete, "complete", "unbiased; close-range VPLs carry light of all depths"},
    PolicyEntry{Policy::partition, "partition", "unbiased; close-range VPLs carry direct light only"},
    PolicyEntry{Policy::paper, "paper", "as in the paper; loses light of several bounces"},
};

}  // namespace

std::span<const SamplerEntry> all_samplers() {
    return kSamplers;
}
const SamplerEntry& sampler_entry(SamplerKind kind) {
    return *std::ranges::find(kSamplers, kind, &SamplerEntry::kind);
}
std::span<const PolicyEntry> all_policies() {
    return kPolicies;
}

std::string to_string(SamplerKind kind) {
    return sampler_entry(kind).name;
}
std::string to_string(Policy policy) {
    return std::ranges::find(kPolicies, policy, &PolicyEntry::policy)->name;
}

std::string sampler_name(const SamplingSettings& settings) {
    return settings.file.empty() ? to_string(settings.sampler) : "file";
}
std::optional<std::string> policy_name(const SamplingSettings& settings) {
    const bool has_policy = settings.file.empty() && settings.sampler == SamplerKind::close_range;
    return has_policy ? std::optional(to_string(settings.policy)) : std::nullopt;
}

VplSet sample_vpls(SamplerStages& stages, const SamplingTask& task) {
    if (task.vpl_count == 0 || task.bounce_count == 0 || task.scene.host_info.emitter_count == 0) {
        return {.vpls = VplBuffer(stages.device, {})};
    }
    return sampler_entry(task.sampler).sample(stages, task);
}

}  // namespace nearlight::core
