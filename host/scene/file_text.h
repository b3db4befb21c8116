// SPDX-License-Identifier: Apache-2.0
// Reading files, whole or in parts, and paths that files name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace nearlight::core {

/// Reads the whole file. Throws Error(ErrorKind::file) if it is missing, unreadable or no regular file.
std::string read_file_text(const std::filesystem::path& file);

/// A file of which only parts are read.
class FileParts {
  public:
    /// Throws Error(ErrorKind::file) if the file is missing, unreadable or no regular file.
    explicit FileParts(const std::filesystem::path& file);

    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// `count` bytes from `begin` on; fewer where the file ends before. Throws Error(ErrorKind::file).
    std::string read(std::uint64_t begin, std::uint64_t count);
    /// Fills `bytes` from `begin` on. Throws Error(ErrorKind::file), also where the file ends before.
    void read_into(std::uint64_t begin, std::span<char> bytes);

  private:
    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
};

/// The path of the file `name` in a folder, with backslashes allowed as separators. An absolute name stays.
std::filesystem::path path_in_folder(const std::filesystem::path& folder, std::string name);

/// The path that `name` stands for in `file`: relative to the folder of `file`, as above.
std::filesystem::path resolve_path(const std::filesystem::path& file, const std::string& name);

/// The file that `name` stands for in `file`, if both may have been written on another computer: the path
/// that resolve_path() returns, or else the bare name in the folder of `file`. If neither is a file, the same
/// two in any case of letters, where of several files the first in alphabetical order counts. If there is no
/// such file, what resolve_path() returns.
std::filesystem::path find_moved_file(const std::filesystem::path& file, const std::string& name);

}  // namespace nearlight::core
