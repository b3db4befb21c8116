// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/sampler.h"

#include <algorithm>
#include <array>

namespace nearlight::core {
namespace {

constexpr std::array kSamplers{
    SamplerEntry{SamplerKind::close_range, "close-range",
                 "evenly over the surfaces close to and in front of the camera", sample_close_range},
    SamplerEntry{SamplerKind::instant_radiosity, "instant-radiosity", "wherever light walks land",
                 sample_instant_radiosity},
    SamplerEntry{SamplerKind::rejection, "rejection",
                 "where light walks land, if the light there matters to the camera", sample_rejection},
    SamplerEntry{SamplerKind::metropolis, "metropolis",
                 "where Markov chains find light that matters to the camera", sample_metropolis},
    SamplerEntry{SamplerKind::bidirectional, "bidirectional",
                 "where light walks land, and where rays from visible points land", sample_bidirectional},
    SamplerEntry{SamplerKind::local, "local",
                 "wherever light walks land, smoothed, with extra lights near each tile", sample_local},
};
constexpr std::array kPolicies{
    PolicyEntry{Policy::complete, "complete", "unbiased; close-range VPLs carry light of all depths"},
    PolicyEntry{Policy::partition, "partition", "unbiased; close-range VPLs carry direct light only"},
    PolicyEntry{Policy::paper, "paper", "as in the paper; loses light of several bounces"},
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
