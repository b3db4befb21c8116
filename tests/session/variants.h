// SPDX-License-Identifier: Apache-2.0
// All samplers and policies, from the tables that the commands use.
#pragma once

#include <string>
#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core::test {

struct Variant {
    SamplerKind sampler;
    Policy policy;
    [[nodiscard]] std::string name() const {
        return core::to_string(sampler) + " " + core::to_string(policy);
    }
};

/// All pairs of a sampler and a policy. Only close-range sampling has policies.
inline std::vector<Variant> all_variants() {
    std::vector<Variant> variants;
    for (const SamplerEntry& sampler : all_samplers()) {
        for (const PolicyEntry& policy : all_policies()) {
            if (sampler.kind == SamplerKind::close_range || policy.policy == Policy::complete) {
                variants.push_back({sampler.kind, policy.policy});
            }
        }
    }
    return variants;
}

}  // namespace nearlight::core::test
