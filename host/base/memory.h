// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>

#include <cstddef>

namespace nearlight::core {

/// The maximum physical memory that this process has held so far, in bytes (Linux counts KiB); 0 if unknown.
inline std::size_t peak_host_bytes() {
    rusage usage{};
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::size_t>(usage.ru_maxrss) * 1024 : 0;
}

}  // namespace nearlight::core
