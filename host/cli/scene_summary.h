// SPDX-License-Identifier: Apache-2.0
// The summary of a scene that `nearlight info` prints.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// The number of materials of each kind that triangles have: "diffuse", "coated", "metal", "glass", "thin
/// glass", …
std::vector<std::pair<std::string, std::size_t>> count_materials(const Scene& scene);

/// The summary as JSON.
nlohmann::ordered_json scene_summary_json(const Scene& scene);
/// The summary as text of several lines.
std::string scene_summary_text(const Scene& scene);

}  // namespace nearlight::core
