// SPDX-License-Identifier: Apache-2.0
// Compiled programs on disk, so that a second run does not compile.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nearlight::core {

/// Whether a program that PoCL made lacks the machine code of one of its kernels: PoCL 3.1 makes such
/// programs where it cannot start the linker, and ends the process that runs them.
[[nodiscard]] bool lacks_a_kernel(std::span<const unsigned char> binary);

/// A folder of files that are named after a hash of their key. A file has its whole key and a checksum, so a
/// file of another key and a damaged file are recognised and ignored, and so is a program that lacks a
/// kernel.
class ProgramCache {
  public:
    /// An empty folder name, or "none", makes a cache that holds nothing.
    explicit ProgramCache(std::filesystem::path dir);

    [[nodiscard]] std::optional<std::vector<unsigned char>> find(const std::string& key) const;
    /// Stores a program. A failure to write is not an error: the next run compiles the program again.
    void store(const std::string& key, const std::vector<unsigned char>& binary) const;

  private:
    [[nodiscard]] std::filesystem::path path_of(const std::string& key) const;

    std::filesystem::path dir_;
};

}  // namespace nearlight::core
