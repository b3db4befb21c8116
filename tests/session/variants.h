// SPDX-License-Identifier: Apache-2.0
// All that there is to test, from the tables that commands know samplers by.
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

/// Policies are of close-range sampling; other samplers do not read them.
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
