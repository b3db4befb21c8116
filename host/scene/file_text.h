// SPDX-License-Identifier: Apache-2.0
// Reading whole files, and paths that files name.
#pragma once

#include <filesystem>
#include <string>

namespace nearlight::core {

/// Reads the whole file. Throws Error(ErrorKind::file) if it is missing, unreadable or no regular file.
std::string read_file_text(const std::filesystem::path& file);

/// The path of the file `name` in a folder, with backslashes allowed as separators. An absolute name stays.
std::filesystem::path path_in_folder(const std::filesystem::path& folder, std::string name);

/// The path that `name` stands for in `file`: relative to the folder of `file`, as above.
std::filesystem::path resolve_path(const std::filesystem::path& file, const std::string& name);

}  // namespace nearlight::core
