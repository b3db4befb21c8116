// SPDX-License-Identifier: Apache-2.0
// The kernel sources that were put into this binary by cmake/EmbedKernels.cmake.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace nearlight::core {

/// The text of kernels/`name` (e.g. "lib/math.cl") as it was at build time, or nothing if there is none.
std::optional<std::string_view> embedded_kernel(std::string_view name);

/// All names that embedded_kernel() knows.
std::vector<std::string_view> embedded_kernel_names();

}  // namespace nearlight::core
