// SPDX-License-Identifier: Apache-2.0
// Where the files are that a scene names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Looks for files as Mitsuba 3 does: in the folders of <path> elements, the last one first, and in the
/// folder of the scene. What an included file names may also stand in the folder of that file.
class FileSearch {
  public:
    explicit FileSearch(const std::filesystem::path& scene);

    /// Adds the folder that a <path> element at `where` names. Calls fail() if there is no such folder.
    void add_folder(const std::string& name, const Location& where);

    /// The file that is called `name` in the file of `where`, with backslashes allowed as separators. If no
    /// folder has it, the path that it would have in the folder of the scene.
    [[nodiscard]] std::filesystem::path find(const std::string& name, const Location& where) const;

  private:
    std::vector<std::filesystem::path> folders_;  ///< the first one that has a file wins
};

}  // namespace nearlight::core::mitsuba
