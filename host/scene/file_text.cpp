// SPDX-License-Identifier: Apache-2.0
#include "host/scene/file_text.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

#include "host/base/files.h"
#include "host/base/words.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

bool is_plain_file(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

/// What a folder has under this name: first what has exactly this name, then what has it in another case, in
/// alphabetical order.
std::vector<std::filesystem::path> entries_called(const std::filesystem::path& folder,
                                                  const std::filesystem::path& name) {
    std::vector<std::filesystem::path> entries;
    std::error_code ignored;
    const std::filesystem::path listed = folder.empty() ? std::filesystem::path(".") : folder;
    const std::filesystem::directory_iterator end;
    for (std::filesystem::directory_iterator entry(listed, ignored); entry != end; entry.increment(ignored)) {
        const std::filesystem::path other = entry->path().filename();
        if (other != name && equal_in_any_case(other.string(), name.string())) {
            entries.push_back(folder / other);
        }
    }
    std::sort(entries.begin(), entries.end());
    if (std::filesystem::exists(folder / name, ignored)) {
        entries.insert(entries.begin(), folder / name);
    }
    return entries;
}

/// The file that lies below the folder under these names, in any case of letters. Empty if there is none.
std::filesystem::path find_below(std::filesystem::path folder, std::span<const std::filesystem::path> names) {
    while (!names.empty() && (names.front() == "." || names.front() == "..")) {
        folder /= names.front();
        names = names.subspan(1);
    }
    if (names.empty()) {
        return is_plain_file(folder) ? folder : std::filesystem::path();
    }
    for (const std::filesystem::path& entry : entries_called(folder, names.front())) {
        if (std::filesystem::path found = find_below(entry, names.subspan(1)); !found.empty()) {
            return found;
        }
    }
    return {};
}

/// The file at a path below the folder, in any case of letters. Empty if there is none.
std::filesystem::path find_in_any_case(const std::filesystem::path& folder,
                                       const std::filesystem::path& path) {
    const std::vector<std::filesystem::path> names(path.begin(), path.end());
    return find_below(folder, names);
}

}  // namespace

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
    read_into(begin, bytes);
    return bytes;
}

void FileParts::read_into(std::uint64_t begin, std::span<char> bytes) {
    if (!bytes.empty()) {
        stream_.seekg(static_cast<std::streamoff>(begin));
        stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    if (!stream_) {
        throw Error(ErrorKind::file, file_.string() + ": cannot be read");
    }
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

std::filesystem::path find_moved_file(const std::filesystem::path& file, const std::string& name) {
    const std::filesystem::path folder = file.parent_path();
    const std::filesystem::path written = path_in_folder(std::filesystem::path(), name);
    const std::filesystem::path as_written = folder / written;
    const std::filesystem::path beside = folder / written.filename();
    if (is_plain_file(as_written)) {
        return as_written;
    }
    if (is_plain_file(beside)) {
        return beside;
    }
    std::filesystem::path found =
        find_in_any_case(written.is_absolute() ? written.root_path() : folder, written.relative_path());
    if (found.empty()) {
        found = find_in_any_case(folder, written.filename());
    }
    return found.empty() ? as_written : found;
}

}  // namespace nearlight::core
