// SPDX-License-Identifier: Apache-2.0
// The methods that are compared: a sampler, and for close-range sampling a policy.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

struct Method {
    SamplerKind sampler = SamplerKind::close_range;
    std::optional<Policy> policy;  ///< set for close-range sampling only

    bool operator==(const Method&) const = default;
};

/// Name of the method, for example "close-range:partition" or "instant-radiosity".
std::string to_string(const Method& method);
/// The names of several, with commas between them.
std::string to_string(std::span<const Method> methods);
/// Name of the method in letters, digits and '-', for names of files.
std::string file_stem(const Method& method);

/// Close-range sampling with the default policy of `nearlight render`.
Method default_method();
/// All samplers, close-range sampling with each of its policies. The default method is first.
std::vector<Method> all_methods();
/// The method with a name of to_string(), or the default method for `close-range`. Throws
/// Error(ErrorKind::invalid_argument), which lists the names, for any other name.
Method parse_method(std::string_view name);

}  // namespace nearlight::core
