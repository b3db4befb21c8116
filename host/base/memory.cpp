// SPDX-License-Identifier: Apache-2.0
#include "host/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace nearlight::core {

std::size_t peak_host_bytes() {
    rusage usage{};  // Linux counts KiB
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::size_t>(usage.ru_maxrss) * 1024 : 0;
}

std::size_t free_address_space() {
    constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return kUnlimited;
    }
    std::ifstream statistics("/proc/self/statm");
    std::size_t pages = 0;
    if (!(statistics >> pages)) {
        return kUnlimited;
    }
    const std::size_t used = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur - std::min<std::size_t>(used, limit.rlim_cur);
}

}  // namespace nearlight::core
