// SPDX-License-Identifier: Apache-2.0
#include "host/base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "host/base/hash.h"

namespace nearlight::core {
namespace {

constexpr const char* kSuffix = ".partial-";

/// The name, for temporary files, of the running kernel and the namespace whose process numbers this process
/// sees: two processes with the same name cannot have the same number. Empty where the system does not tell.
std::string system_name() {
    std::ifstream stream("/proc/sys/kernel/random/boot_id");
    std::string boot;
    std::error_code error;
    const std::filesystem::path processes = std::filesystem::read_symlink("/proc/self/ns/pid", error);
    if (!std::getline(stream, boot) || error) {
        return "";
    }
    return hex_digits(hash64(boot + processes.string()));
}

/// The temporary file is in the target's folder, because a rename cannot cross file systems. The process and
/// a count tell the writers on one machine apart, and the random number tells apart machines that share a
/// folder.
std::filesystem::path temporary_path(const std::filesystem::path& target, const std::string& system) {
    static std::atomic<unsigned> count{0};
    std::array<char, 96> name{};
    std::snprintf(name.data(), name.size(), "%s-%ld-%u-%08x", system.c_str(), static_cast<long>(getpid()),
                  count++, std::random_device{}());
    return target.string() + kSuffix + name.data();
}

/// The number of the process that `name`, the end of a temporary file's name after the system's, begins with.
std::optional<pid_t> writer_of(std::string_view name) {
    long process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    const bool is_number = error == std::errc() && end != name.data() + name.size() && *end == '-';
    return is_number && process > 0 ? std::optional(static_cast<pid_t>(process)) : std::nullopt;
}

/// Removes temporary files of this target whose writers were killed. Those of other systems stay, because
/// nothing tells whether their writers live.
void remove_abandoned(const std::filesystem::path& target, const std::string& system) {
    namespace fs = std::filesystem;
    if (system.empty()) {
        return;
    }
    const std::string beginning = target.filename().string() + kSuffix + system + "-";
    std::error_code error;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(beginning)) {
            continue;
        }
        const std::optional<pid_t> writer = writer_of(std::string_view(name).substr(beginning.size()));
        if (writer && kill(*writer, 0) != 0 && errno == ESRCH) {
            std::error_code ignored;
            fs::remove(entry->path(), ignored);
        }
    }
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

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
    static const std::string system = system_name();
    remove_abandoned(target_, system);
    temporary_ = temporary_path(target_, system);
}

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
