// SPDX-License-Identifier: Apache-2.0
// Folders, text files and the texts of numbers.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nearlight {

/// With those above it. Throws Error(ExitCode::file).
void make_folder(const std::filesystem::path& folder);
/// Under a temporary name first, then renamed. Throws Error(ExitCode::file).
void write_text(const std::filesystem::path& file, std::string_view text);
/// All bytes. Throws Error(ExitCode::file).
std::string read_bytes(const std::filesystem::path& file);

/// Hexadecimal, all bits: for keys.
std::string exact_text(double value);

}  // namespace nearlight
