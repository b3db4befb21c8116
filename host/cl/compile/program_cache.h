// SPDX-License-Identifier: Apache-2.0
// Compiled programs on disk, so that a second run does not compile.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nearlight::core {

/// A folder of files that are named after a hash of their key. A file has its whole key and a checksum, so a
/// file of another key and a damaged file are recognised and ignored.
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
