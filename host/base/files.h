// SPDX-License-Identifier: Apache-2.0
// Folders, text files and the texts of numbers.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nearlight::core {

/// With those above it. Throws Error(ErrorKind::file).
void make_folder(const std::filesystem::path& folder);
/// The old file survives where this fails. Throws Error(ErrorKind::file).
void write_text(const std::filesystem::path& file, std::string_view text);
/// All bytes. Throws Error(ErrorKind::file).
std::string read_bytes(const std::filesystem::path& file);

/// Hexadecimal, all bits: for keys.
std::string exact_text(double value);

}  // namespace nearlight::core
