// SPDX-License-Identifier: Apache-2.0
// Folders, names of files, text files and the texts of numbers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace nearlight::core {

/// The extension of a file's name, with its dot and in lower case, because A.EXR is what a.exr is.
std::string lower_case_extension(const std::filesystem::path& file);
/// Makes a folder and the missing folders above it. Throws Error(ErrorKind::file).
void make_folder(const std::filesystem::path& folder);
/// What is to be said if the folder of a file is not there; empty if it is.
std::string missing_folder_text(const std::filesystem::path& file);
/// Replaces the whole file, by the parts one after another. After a failure the old file is still there.
/// Throws Error(ErrorKind::file).
void write_parts(const std::filesystem::path& file, std::span<const std::span<const std::byte>> parts);
void write_text(const std::filesystem::path& file, std::string_view text);
/// Why a file is not worth opening for reading, such as "no such file"; empty if it is. What is not a regular
/// file, such as a pipe or a device, is not, because it may never end.
std::string reason_not_to_read(const std::filesystem::path& file);
/// Reads the whole file. Throws Error(ErrorKind::file).
std::string read_bytes(const std::filesystem::path& file);

/// The value in hexadecimal, with all its bits, as printf's %a writes it without a locale; for use in keys.
std::string exact_text(double value);

}  // namespace nearlight::core
