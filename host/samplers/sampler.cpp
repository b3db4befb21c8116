// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sampler.h"

#include <algorithm>
#include <array>

namespace nearlight::core {
namespace {

constexpr std::array kSamplers{
    SamplerEntry{SamplerKind::close_range, "close-range", "evenly over surfaces near and before the camera",
                 sample_close_range},
    SamplerEntry{SamplerKind::instant_radiosity, "instant-radiosity", "wherever light walks land",
                 sample_instant_radiosity},
    SamplerEntry{SamplerKind::rejection, "rejection", "light walks that the camera needs", sample_rejection},
    SamplerEntry{SamplerKind::metropolis, "metropolis", "where Markov chains find what the camera needs",
                 sample_metropolis},
    SamplerEntry{SamplerKind::bidirectional, "bidirectional",
                 "where walks from lights and from the view land", sample_bidirectional},
    SamplerEntry{SamplerKind::local, "local", "the same, smoothed, with lights of each tile for what is near",
                 sample_local},
};
constexpr std::array kPolicies{
    PolicyEntry{Policy::complete, "complete", "unbiased, light of all depths on the patches"},
    PolicyEntry{Policy::partition, "partition", "unbiased, direct light only on the patches"},
    PolicyEntry{Policy::paper, "paper", "loses bounces"},
};

const SamplerEntry& entry_of(SamplerKind kind) {
    return *std::ranges::find(kSamplers, kind, &SamplerEntry::kind);
}

}  // namespace

std::span<const SamplerEntry> all_samplers() {
    return kSamplers;
}
std::span<const PolicyEntry> all_policies() {
    return kPolicies;
}

std::string to_string(SamplerKind kind) {
    return entry_of(kind).name;
}
std::string to_string(Policy policy) {
    return std::ranges::find(kPolicies, policy, &PolicyEntry::policy)->name;
}

VplSet sample_vpls(SamplerStages& stages, const SamplingTask& task) {
    if (task.vpl_count == 0 || task.bounce_count == 0 || task.scene.host_info.emitter_count == 0) {
        return {};
    }
    return entry_of(task.sampler).sample(stages, task);
}

}  // namespace nearlight::core
