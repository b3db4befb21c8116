// SPDX-License-Identifier: Apache-2.0
// What `nearlight info` tells of a scene.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Bytes by part; the parts are in the order in which they are told.
struct MemoryEstimate {
    using Parts = std::vector<std::pair<std::string, std::uint64_t>>;
    Parts host;
    Parts device;
};
/// Of a render at the scene's own size with the whole picture at once, one sample a pixel at a time;
/// rendering in bands needs less. The trees are taken to have two triangles a leaf.
MemoryEstimate estimate_memory(const Scene& scene);

/// How many materials of each kind, kinds without any left out: "diffuse", "coated", "metal", "glass", "thin
/// glass".
std::vector<std::pair<std::string, std::size_t>> count_materials(const Scene& scene);

nlohmann::ordered_json scene_summary_json(const Scene& scene);
/// The same for people, several lines.
std::string scene_summary_text(const Scene& scene);

}  // namespace nearlight::core
