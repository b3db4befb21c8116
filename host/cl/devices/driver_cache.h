// SPDX-License-Identifier: Apache-2.0
// The folder in which PoCL keeps what it compiled.
#pragma once

#include <filesystem>

namespace nearlight::core {

/// Gives PoCL a temporary folder for its files, which goes when the process ends, if the one that it would
/// take cannot be written or is on a full disk: there PoCL finds no device, or ends the process. Sets
/// POCL_CACHE_DIR, so no other thread may run yet.
void ensure_driver_cache();

/// The folder in which PoCL keeps files; empty if no variable names one, so that PoCL takes one in /tmp.
std::filesystem::path driver_cache();

/// Removes the kernels that PoCL has left empty in its folder, and returns how many. PoCL 3.1 does so where
/// it cannot start the linker, for lack of processes, of memory or of open files. It would load these files
/// from then on, fail, and end the process each time.
std::size_t remove_empty_kernels();

}  // namespace nearlight::core
