// SPDX-License-Identifier: Apache-2.0
// How much memory a render of a scene takes, for `nearlight info`.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Estimated bytes of each part, in the order in which they are printed.
struct MemoryEstimate {
    using Parts = std::vector<std::pair<std::string, std::uint64_t>>;
    Parts host;
    Parts device;
};
/// Estimates the memory of a render at the scene's own size with the default settings: the whole picture on
/// the host, and one band of it at a time on a device, which is taken for a CPU. VPLs and what few scenes
/// need (veils, shared reflections) are left out.
MemoryEstimate estimate_memory(const Scene& scene);

}  // namespace nearlight::core
