// SPDX-License-Identifier: Apache-2.0
// Notes of what loaders could not represent exactly.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Collects notes, and says them as warnings at once, so that they are known even if loading fails later.
/// Each text is kept once, with the place where it first came up.
class NoteSink {
  public:
    NoteSink(std::vector<Note>& notes, bool strict) : notes_(notes), strict_(strict) {}

    /// Notes an approximation. Throws Error(ErrorKind::file) if loading is strict.
    void approximation(const std::filesystem::path& file, int line, const std::string& text);
    /// Notes something that makes the picture no less exact; never an error.
    void remark(const std::filesystem::path& file, int line, const std::string& text);

  private:
    std::vector<Note>& notes_;
    std::set<std::string> said_;
    bool strict_;
};

}  // namespace nearlight::core
