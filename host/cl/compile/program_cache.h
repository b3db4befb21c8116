// SPDX-License-Identifier: Apache-2.0
// Compiled programs on disk, so that a second run does not compile.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nearlight::core {

/// A folder of files named after a hash of their key. A file carries its whole key and a checksum, so neither
/// a hash collision nor a damaged file can be taken for the program.
class ProgramCache {
  public:
    /// An empty folder name, or "none", makes a cache that holds nothing.
    explicit ProgramCache(std::filesystem::path dir);

    [[nodiscard]] std::optional<std::vector<unsigned char>> find(const std::string& key) const;
    /// Failure to write is no error: the next run compiles again.
    void store(const std::string& key, const std::vector<unsigned char>& binary) const;

  private:
    [[nodiscard]] std::filesystem::path path_of(const std::string& key) const;

    std::filesystem::path dir_;
};

}  // namespace nearlight::core
