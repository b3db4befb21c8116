// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "host/scene/scene_loader.h"

namespace nearlight::core::fuzz {

/// Loads a scene, which may be refused. Aborts if what it made breaks a promise of host/scene/scene.h.
void load_and_check(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace nearlight::core::fuzz
