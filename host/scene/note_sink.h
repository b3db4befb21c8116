// SPDX-License-Identifier: Apache-2.0
// Where loaders say what they could not take over exactly.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Collects notes; each text is said once, with the place where it came up first.
class NoteSink {
  public:
    NoteSink(std::vector<Note>& notes, bool strict) : notes_(notes), strict_(strict) {}

    /// An approximation. Throws Error(ErrorKind::file) when strict.
    void approximation(const std::filesystem::path& file, int line, const std::string& text);
    /// Something to know that makes the picture no less exact; never an error.
    void remark(const std::filesystem::path& file, int line, const std::string& text);

  private:
    std::vector<Note>& notes_;
    std::set<std::string> said_;
    bool strict_;
};

}  // namespace nearlight::core
