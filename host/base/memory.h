// SPDX-License-Identifier: Apache-2.0
// What this process takes of the machine's memory.
#pragma once

#include <cstddef>

namespace nearlight::core {

/// The maximum physical memory that this process has held so far, in bytes; 0 if unknown.
std::size_t peak_host_bytes();

/// The bytes of address space that a limit (RLIMIT_AS, the shell's `ulimit -v`) leaves this process; the
/// maximum of the type if there is no limit, or if the system does not tell.
std::size_t free_address_space();

}  // namespace nearlight::core
