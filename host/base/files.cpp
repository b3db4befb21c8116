// SPDX-License-Identifier: Apache-2.0
#include "host/base/files.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>

#include "host/base/atomic_file.h"
#include "host/base/words.h"
#include "nearlight/error.h"

namespace nearlight::core {

namespace {

/// Whether the file is what Git's extension for large files (LFS) leaves in the place of a file that was not
/// fetched.
bool is_lfs_pointer(const std::filesystem::path& file) {
    constexpr std::string_view kBeginning = "version https://git-lfs.github.com/spec/";
    constexpr std::uintmax_t kMaxSize = 1024;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size < kBeginning.size() || size >= kMaxSize) {
        return false;
    }
    std::string bytes(kBeginning.size(), '\0');
    std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return bytes == kBeginning;
}

}  // namespace

std::string lower_case_extension(const std::filesystem::path& file) {
    return lower_case(file.extension().string());
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder)) {
        throw Error(ErrorKind::file, "cannot make the folder '" + folder.string() + "': " +
                                         (error ? error.message() : "a file of that name is in the way"));
    }
}

std::string missing_folder_text(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::error_code ignored;
    return std::filesystem::is_directory(folder, ignored)
               ? std::string()
               : "there is no folder '" + folder.string() + "'; create it first";
}

void write_parts(const std::filesystem::path& file, std::span<const std::span<const std::byte>> parts) {
    AtomicFile result(file);
    std::ofstream stream(result.temporary(), std::ios::binary);
    for (const std::span<const std::byte> part : parts) {
        stream.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
    }
    stream.close();
    if (!stream || result.commit(Durability::result)) {
        throw Error(ErrorKind::file,
                    "cannot write '" + file.string() + "'; is the disk full, or the folder read-only?");
    }
}

void write_text(const std::filesystem::path& file, std::string_view text) {
    write_parts(file, std::array{std::as_bytes(std::span(text))});
}

std::string reason_not_to_read(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code error;
    switch (fs::status(file, error).type()) {
        case fs::file_type::regular:
            return is_lfs_pointer(file) ? "it only points to a file of Git LFS; 'git lfs pull' fetches that"
                                        : "";
        case fs::file_type::not_found:
            return "no such file";
        case fs::file_type::directory:
            return "it is a folder, not a file";
        case fs::file_type::none:
            return error.message();
        default:
            return "it is a pipe or a device, not a file";
    }
}

std::string read_bytes(const std::filesystem::path& file) {
    if (const std::string reason = reason_not_to_read(file); !reason.empty()) {
        throw Error(ErrorKind::file, "cannot read '" + file.string() + "': " + reason);
    }
    try {
        std::ifstream stream(file, std::ios::binary);
        std::string bytes{std::istreambuf_iterator<char>(stream), {}};
        if (stream) {
            return bytes;
        }
    } catch (const std::ios_base::failure&) {
        // The iterator throws where the disk fails, whatever the stream's own exceptions are.
    }
    throw Error(ErrorKind::file, "cannot read '" + file.string() + "'");
}

std::string exact_text(double value) {
    std::array<char, 40> text{};
    char* const end =
        std::to_chars(text.data(), text.data() + text.size(), std::abs(value), std::chars_format::hex).ptr;
    const std::string sign = std::signbit(value) ? "-" : "";
    return sign + (std::isfinite(value) ? "0x" : "") + std::string(text.data(), end);
}

}  // namespace nearlight::core
