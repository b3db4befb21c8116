// SPDX-License-Identifier: Apache-2.0
#include "host/scene/file_text.h"

#include <algorithm>
#include <fstream>

#include "nearlight/error.h"

namespace nearlight::core {

std::string read_file_text(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        throw Error(ErrorKind::file, file.string() + ": no such file");
    }
    if (std::filesystem::is_directory(file, ignored)) {
        throw Error(ErrorKind::file, file.string() + ": is a directory, not a file");
    }
    std::ifstream stream(file, std::ios::binary);
    std::string text;
    const auto size = std::filesystem::file_size(file, ignored);
    if (stream && !ignored) {
        text.resize(size);
        stream.read(text.data(), static_cast<std::streamsize>(size));
    }
    if (!stream) {
        throw Error(ErrorKind::file, file.string() + ": cannot be read");
    }
    return text;
}

std::filesystem::path resolve_path(const std::filesystem::path& file, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return file.parent_path() / name;
}

}  // namespace nearlight::core
