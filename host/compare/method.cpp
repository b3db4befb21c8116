// SPDX-License-Identifier: Apache-2.0
#include "host/compare/method.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/words.h"
#include "nearlight/error.h"

namespace nearlight::core {

std::string to_string(const Method& method) {
    const std::string sampler = to_string(method.sampler);
    return method.policy ? fmt::format("{}:{}", sampler, to_string(*method.policy)) : sampler;
}

std::string to_string(std::span<const Method> methods) {
    return joined(methods, ", ", [](const Method& method) { return to_string(method); });
}

std::string file_stem(const Method& method) {
    std::string stem = to_string(method);
    std::replace(stem.begin(), stem.end(), ':', '-');
    return stem;
}

Method default_method() {
    return {SamplerKind::close_range, SamplingSettings{}.policy};
}

std::vector<Method> all_methods() {
    std::vector<Method> methods{default_method()};
    for (const SamplerEntry& sampler : all_samplers()) {
        if (sampler.kind != SamplerKind::close_range) {
            methods.push_back({sampler.kind, std::nullopt});
            continue;
        }
        for (const PolicyEntry& policy : all_policies()) {
            if (policy.policy != default_method().policy) {
                methods.push_back({sampler.kind, policy.policy});
            }
        }
    }
    return methods;
}

Method parse_method(std::string_view name) {
    if (name == to_string(SamplerKind::close_range)) {
        return default_method();
    }
    for (const Method& method : all_methods()) {
        if (name == to_string(method)) {
            return method;
        }
    }
    throw Error(ErrorKind::invalid_argument,
                "unknown sampler '" + std::string(name) + "'; choose one of: " + to_string(all_methods()));
}

}  // namespace nearlight::core
