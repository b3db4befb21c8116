// SPDX-License-Identifier: Apache-2.0
// What this process takes of the machine's memory, and what is left.
#pragma once

#include <cstddef>
#include <filesystem>

namespace nearlight::core {

/// The maximum physical memory that this process has held so far, in bytes; 0 if unknown.
std::size_t peak_host_bytes();

/// The bytes of address space that a limit (RLIMIT_AS, the shell's `ulimit -v`) leaves this process; the
/// maximum of the type if there is no limit, or if the system does not tell.
std::size_t free_address_space();

/// The bytes of memory that this process can still take before the system runs out of it or ends a process:
/// available memory plus free swap, each no more than the limits of its control groups (containers, job
/// schedulers; version 2) leave. The maximum of the type if the system does not tell. `proc` and `groups` are
/// where Linux has both file systems.
std::size_t free_memory(const std::filesystem::path& proc = "/proc",
                        const std::filesystem::path& groups = "/sys/fs/cgroup");

}  // namespace nearlight::core
