// SPDX-License-Identifier: Apache-2.0
// Scenes made by others, which are not part of this repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace nearlight::core::test {

/// Path of a scene in the folder NEARLIGHT_TEST_SCENES or else beside the checkout; empty if the scene is not
/// on this machine.
inline std::filesystem::path real_scene(const std::string& name) {
    const char* folder = std::getenv("NEARLIGHT_TEST_SCENES");
    const std::filesystem::path root =
        folder != nullptr ? folder : std::filesystem::path(NEARLIGHT_SOURCE_DIR) / ".." / "shared" / "scenes";
    return std::filesystem::exists(root / name) ? root / name : std::filesystem::path();
}

}  // namespace nearlight::core::test
