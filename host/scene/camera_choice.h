// SPDX-License-Identifier: Apache-2.0
// Which of a file's cameras is wanted.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace nearlight::core {

/// The index of the camera that `wanted` names, by one of its names or by its number, counted from 1; 0 if
/// `wanted` is empty. `names` has the names of each camera, of which some may be empty. Throws
/// Error(ErrorKind::invalid_argument) if there is no such camera.
std::size_t choose_camera(const std::filesystem::path& file, std::span<const std::vector<std::string>> names,
                          const std::string& wanted);

}  // namespace nearlight::core
