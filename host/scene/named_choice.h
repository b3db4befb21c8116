// SPDX-License-Identifier: Apache-2.0
// Which of a file's cameras or animations is wanted.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace nearlight::core {

/// The index of the thing that `wanted` names, by one of its names or by its number, counted from 1; 0 if
/// `wanted` is empty. `kind` is what things are called, such as "camera", and `names` has the names of each;
/// some may be empty. Throws Error(ErrorKind::invalid_argument) if there is no such thing.
std::size_t choose_named(const std::filesystem::path& file, const std::string& kind,
                         std::span<const std::vector<std::string>> names, const std::string& wanted);

}  // namespace nearlight::core
