// SPDX-License-Identifier: Apache-2.0
#include "host/scene/file_text.h"

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "host/base/files.h"
#include "nearlight/error.h"

namespace nearlight::core {

std::string read_file_text(const std::filesystem::path& file) {
    if (const std::string reason = reason_not_to_read(file); !reason.empty()) {
        throw Error(ErrorKind::file, file.string() + ": " + reason);
    }
    std::error_code ignored;
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    const bool has_too_many_open = !stream && errno == EMFILE;
    std::string text;
    const auto size = std::filesystem::file_size(file, ignored);
    if (stream && !ignored) {
        text.resize(size);
        stream.read(text.data(), static_cast<std::streamsize>(size));
    }
    if (!stream) {
        throw Error(ErrorKind::file, file.string() + ": cannot be read" +
                                         (has_too_many_open ? ": too many files are open (ulimit -n)" : ""));
    }
    return text;
}

std::filesystem::path path_in_folder(const std::filesystem::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return folder / name;
}

std::filesystem::path resolve_path(const std::filesystem::path& file, const std::string& name) {
    return path_in_folder(file.parent_path(), name);
}

}  // namespace nearlight::core
