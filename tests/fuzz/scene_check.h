// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace nearlight::core::fuzz {

/// Loads a scene, which may be refused. Aborts if what it made breaks a promise of host/scene/scene.h.
void load_and_check(const std::filesystem::path& file);

}  // namespace nearlight::core::fuzz
