// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/driver_cache.h"

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "host/base/message.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// The value of a variable; empty if it is not set.
fs::path path_in(const char* variable) {
    const char* const value = std::getenv(variable);
    return value == nullptr ? "" : value;
}

/// What the disk must have room for: several times what all kernels of one command take.
constexpr std::uintmax_t kMinFreeBytes = std::uintmax_t{32} << 20;

/// Why PoCL cannot keep files in the folder, as the end of a sentence; empty if it can. The folder need not
/// be there yet.
std::string reason_not_to_keep(fs::path folder) {
    std::error_code error;
    while (!fs::exists(folder, error) && folder.has_relative_path()) {
        folder = folder.parent_path();
    }
    if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK | X_OK) != 0) {
        return "cannot be written";
    }
    const fs::space_info space = fs::space(folder, error);
    return !error && space.available < kMinFreeBytes ? "is on a full disk" : "";
}

/// A folder that goes with the process which made it.
class TemporaryCache {
  public:
    TemporaryCache() {
        std::error_code error;
        for (const fs::path& place : {fs::temp_directory_path(error), fs::path("/dev/shm")}) {
            std::string name = (place / "nearlight-pocl-XXXXXX").string();
            if (reason_not_to_keep(place).empty() && mkdtemp(name.data()) != nullptr) {
                folder_ = name;
                return;
            }
        }
    }
    TemporaryCache(const TemporaryCache&) = delete;
    TemporaryCache& operator=(const TemporaryCache&) = delete;
    ~TemporaryCache() {
        std::error_code ignored;
        if (!folder_.empty() && getpid() == owner_) {
            fs::remove_all(folder_, ignored);
        }
    }
    [[nodiscard]] const fs::path& folder() const { return folder_; }

  private:
    fs::path folder_;
    pid_t owner_ = getpid();
};

}  // namespace

// PoCL 3 to 6 look in this order.
fs::path driver_cache() {
    if (const fs::path set = path_in("POCL_CACHE_DIR"); !set.empty()) {
        return set;
    }
    if (const fs::path cache = path_in("XDG_CACHE_HOME"); !cache.empty()) {
        return cache / "pocl";
    }
    const fs::path home = path_in("HOME");
    return home.empty() ? home : home / ".cache" / "pocl";
}

// PoCL's names are PROGRAM/KERNEL/SIZES/KERNEL.so. Other files may be those that it has just begun.
std::size_t remove_empty_kernels() {
    std::size_t removed = 0;
    std::error_code error;
    fs::recursive_directory_iterator entry(driver_cache(), error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        std::error_code unknown;
        const fs::path& path = entry->path();
        if (path.extension() == ".so" && path.stem() == path.parent_path().parent_path().filename() &&
            entry->file_size(unknown) == 0 && !unknown) {
            removed += fs::remove(path, unknown) ? 1 : 0;
        }
    }
    return removed;
}

void ensure_driver_cache() {
    const fs::path cache = driver_cache();
    const std::string reason = cache.empty() ? "" : reason_not_to_keep(fs::absolute(cache));
    if (reason.empty()) {
        return;
    }
    static const TemporaryCache temporary;
    const std::string fault = "'" + cache.string() + "' " + reason;
    if (temporary.folder().empty()) {
        say_warning(fault +
                    ", and neither is there another folder for what PoCL compiles, so that it may fail; " +
                    "free space on the disk");
        return;
    }
    setenv("POCL_CACHE_DIR", temporary.folder().c_str(), 1);
    say_warning(fault +
                ", so that PoCL keeps nothing that it compiled; set POCL_CACHE_DIR to another folder");
}

}  // namespace nearlight::core
