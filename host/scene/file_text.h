// SPDX-License-Identifier: Apache-2.0
// Reading whole files, and paths that files name.
#pragma once

#include <filesystem>
#include <string>

namespace nearlight::core {

/// Throws Error(ErrorKind::file) where the file is missing, a directory or unreadable.
std::string read_file_text(const std::filesystem::path& file);

/// `name` as written in `file`: relative to its folder, backslashes allowed as separators.
std::filesystem::path resolve_path(const std::filesystem::path& file, std::string name);

}  // namespace nearlight::core
