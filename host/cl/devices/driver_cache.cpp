// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/driver_cache.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "host/base/message.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// The folder in which PoCL 3 to 6 make theirs; empty if there is none, and they take one in /tmp.
fs::path users_cache() {
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    if (cache != nullptr && *cache != '\0') {
        return cache;
    }
    const char* const home = std::getenv("HOME");
    return home != nullptr && *home != '\0' ? fs::path(home) / ".cache" : fs::path();
}

/// Whether the folder can be written, or made if it is not there.
bool can_have_folder(fs::path folder) {
    std::error_code error;
    while (!fs::exists(folder, error) && folder.has_relative_path()) {
        folder = folder.parent_path();
    }
    return fs::is_directory(folder, error) && access(folder.c_str(), W_OK | X_OK) == 0;
}

/// A folder that goes with the process which made it.
class TemporaryCache {
  public:
    TemporaryCache() {
        std::error_code error;
        std::string name = (fs::temp_directory_path(error) / "nearlight-pocl-XXXXXX").string();
        if (!error && mkdtemp(name.data()) != nullptr) {
            folder_ = name;
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

void ensure_driver_cache() {
    const fs::path cache = users_cache();
    if (std::getenv("POCL_CACHE_DIR") != nullptr || cache.empty() ||
        can_have_folder(fs::absolute(cache) / "pocl")) {
        return;
    }
    static const TemporaryCache temporary;
    if (!temporary.folder().empty()) {
        setenv("POCL_CACHE_DIR", temporary.folder().c_str(), 1);
        say_warning("'" + cache.string() +
                    "' cannot be written, so that PoCL keeps nothing that it compiled; set " +
                    "XDG_CACHE_HOME to another folder");
    }
}

}  // namespace nearlight::core
