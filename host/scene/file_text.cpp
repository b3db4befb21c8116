// SPDX-License-Identifier: Apache-2.0
#include "host/scene/file_text.h"

#include <algorithm>
#include <cerrno>

#include "host/base/files.h"
#include "nearlight/error.h"

namespace nearlight::core {

FileParts::FileParts(const std::filesystem::path& file) : file_(file) {
    if (const std::string reason = reason_not_to_read(file); !reason.empty()) {
        throw Error(ErrorKind::file, file.string() + ": " + reason);
    }
    std::error_code error;
    errno = 0;
    stream_.open(file, std::ios::binary);
    const bool has_too_many_open = !stream_ && errno == EMFILE;
    size_ = std::filesystem::file_size(file, error);
    if (!stream_ || error) {
        throw Error(ErrorKind::file, file.string() + ": cannot be read" +
                                         (has_too_many_open ? ": too many files are open (ulimit -n)" : ""));
    }
}

std::string FileParts::read(std::uint64_t begin, std::uint64_t count) {
    std::string bytes(std::min(count, size_ - std::min(begin, size_)), '\0');
    if (!bytes.empty()) {
        stream_.seekg(static_cast<std::streamoff>(begin));
        stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    if (!stream_) {
        throw Error(ErrorKind::file, file_.string() + ": cannot be read");
    }
    return bytes;
}

std::string read_file_text(const std::filesystem::path& file) {
    FileParts parts(file);
    return parts.read(0, parts.size());
}

std::filesystem::path path_in_folder(const std::filesystem::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return folder / name;
}

std::filesystem::path resolve_path(const std::filesystem::path& file, const std::string& name) {
    return path_in_folder(file.parent_path(), name);
}

}  // namespace nearlight::core
