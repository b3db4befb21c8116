// SPDX-License-Identifier: Apache-2.0
// What is compared: a sampler, and for close-range sampling a policy with it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

struct Method {
    SamplerKind sampler = SamplerKind::close_range;
    std::optional<Policy> policy;  ///< of close-range only

    bool operator==(const Method&) const = default;
};

/// "close-range:partition", "instant-radiosity".
std::string to_string(const Method& method);
/// The same in letters, digits and '-', for names of files.
std::string file_stem(const Method& method);

/// Close-range sampling with the policy that `nearlight render` takes where none is given.
Method default_method();
/// Every sampler there is, close-range with each of its policies; the default method first.
std::vector<Method> all_methods();
/// A name as to_string() gives it, or `close-range` for the default method. Throws
/// Error(ErrorKind::invalid_argument) that lists the names.
Method parse_method(std::string_view name);

}  // namespace nearlight::core
