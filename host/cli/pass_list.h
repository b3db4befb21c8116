// SPDX-License-Identifier: Apache-2.0
// The samples of each pass as text: "16*3,7" is three passes of 16 samples per pixel and one of 7.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// The maximum number of passes in a list.
inline constexpr uint kMaxListedPasses = 1'000'000;

std::string pass_list_text(std::span<const uint> samples);

/// Throws Error(ErrorKind::invalid_argument) if the text is no such list, or lists a pass of more than 65536
/// samples or more than a million passes.
std::vector<uint> parse_pass_list(const std::string& text);

}  // namespace nearlight::core
