// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <random>
#include <utility>

namespace nearlight::core {
namespace {

/// The temporary file is in the target's folder, because a rename cannot cross file systems. The process and
/// a count tell the writers on one machine apart, and the random number tells apart machines that share a
/// folder.
std::filesystem::path temporary_path(const std::filesystem::path& target) {
    static std::atomic<unsigned> count{0};
    std::array<char, 64> suffix{};
    std::snprintf(suffix.data(), suffix.size(), ".partial-%ld-%u-%08x", static_cast<long>(getpid()), count++,
                  std::random_device{}());
    return target.string() + suffix.data();
}

/// Without a flush, a file system may record the new name before the data, and a power failure leaves an
/// empty file.
std::error_code flush_to_disk(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return {errno, std::generic_category()};
    }
    const int error = fsync(descriptor) == 0 ? 0 : errno;
    close(descriptor);
    // Some file systems cannot flush, which is no reason to refuse the file.
    return {error == EINVAL ? 0 : error, std::generic_category()};
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(temporary_path(target_)) {}

AtomicFile::~AtomicFile() {
    if (!temporary_.empty()) {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    std::swap(target_, other.target_);
    std::swap(temporary_, other.temporary_);
    return *this;
}

std::error_code AtomicFile::commit(Durability durability) {
    std::error_code error;
    if (durability == Durability::result) {
        error = flush_to_disk(temporary_);
    }
    if (!error) {
        std::filesystem::rename(temporary_, target_, error);
    }
    if (!error) {
        temporary_.clear();
    }
    return error;
}

}  // namespace nearlight::core
