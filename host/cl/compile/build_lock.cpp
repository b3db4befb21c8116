// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/build_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <limits>
#include <system_error>
#include <thread>

#include "host/base/hash.h"
#include "host/base/stopwatch.h"

namespace nearlight::core {
namespace {

constexpr std::chrono::milliseconds kPause{10};
constexpr double kMaxSeconds = 300;

/// Takes the byte of a key in the file that all processes lock. Locks that belong to the open file, unlike
/// those that belong to a process, also keep two threads of one process apart. Returns 0 or an error number.
int try_lock(int file, const std::string& key) {
#ifdef F_OFD_SETLK
    struct flock range {};
    range.l_type = F_WRLCK;
    range.l_whence = SEEK_SET;
    range.l_start = static_cast<off_t>(hash64(key) & std::numeric_limits<std::int32_t>::max());
    range.l_len = 1;
    return fcntl(file, F_OFD_SETLK, &range) == 0 ? 0 : errno;
#else
    static_cast<void>(file);
    static_cast<void>(key);
    return ENOTSUP;
#endif
}

}  // namespace

BuildLock::BuildLock(const std::filesystem::path& folder, const std::string& key,
                     const std::function<bool()>& give_up) {
    if (folder.empty()) {
        return;
    }
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    file_ = open((folder / "nearlight.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    const Stopwatch watch;
    while (file_ >= 0 && !held_) {
        const int error = try_lock(file_, key);
        held_ = error == 0;
        const bool taken = error == EAGAIN || error == EACCES || error == EINTR;
        if (held_ || !taken || give_up() || watch.seconds() > kMaxSeconds) {
            return;
        }
        std::this_thread::sleep_for(kPause);
    }
}

BuildLock::~BuildLock() {
    if (file_ >= 0) {
        close(file_);
    }
}

}  // namespace nearlight::core
