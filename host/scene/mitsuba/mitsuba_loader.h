// SPDX-License-Identifier: Apache-2.0
// Mitsuba XML, versions 0.5 to 3.
#pragma once

#include "host/scene/scene_loader.h"

namespace nearlight::core {

Scene load_mitsuba_scene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace nearlight::core
