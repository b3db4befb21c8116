// SPDX-License-Identifier: Apache-2.0
// The summary of a scene that `nearlight info` prints.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
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
/// Estimates the memory of a render at the scene's own size with the whole picture at once, one sample per
/// pixel at a time. Rendering in bands needs less. The estimate assumes two triangles per leaf of the trees.
MemoryEstimate estimate_memory(const Scene& scene);

/// The number of materials of each kind that occurs: "diffuse", "coated", "metal", "glass", "thin glass".
std::vector<std::pair<std::string, std::size_t>> count_materials(const Scene& scene);

/// The summary as JSON.
nlohmann::ordered_json scene_summary_json(const Scene& scene);
/// The summary as text of several lines.
std::string scene_summary_text(const Scene& scene);

}  // namespace nearlight::core
