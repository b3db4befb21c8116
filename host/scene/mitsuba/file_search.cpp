// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/file_search.h"

#include "host/scene/file_text.h"

namespace nearlight::core::mitsuba {

namespace fs = std::filesystem;

FileSearch::FileSearch(const fs::path& scene) : folders_{scene.parent_path()} {}

void FileSearch::add_folder(const std::string& name, const Location& where) {
    const fs::path folder = find(name, where);
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        fail(where, "folder '" + folder.string() + "' does not exist");
    }
    folders_.insert(folders_.begin(), folder);
}

fs::path FileSearch::find(const std::string& name, const Location& where) const {
    std::error_code ignored;
    for (const fs::path& folder : folders_) {
        if (fs::path file = path_in_folder(folder, name); fs::exists(file, ignored)) {
            return file;
        }
    }
    if (fs::path file = resolve_path(*where.file, name); fs::exists(file, ignored)) {
        return file;
    }
    return path_in_folder(folders_.back(), name);
}

}  // namespace nearlight::core::mitsuba
