// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace nearlight::core {

/// Gives PoCL a temporary folder for its files, which goes when the process ends, if the one that it would
/// take cannot be written or is on a full disk: it then has no device, or ends the process. Sets
/// POCL_CACHE_DIR, so no other thread may run yet.
void ensure_driver_cache();

/// The folder in which PoCL keeps files; empty if there is none, and it takes one in /tmp.
std::filesystem::path driver_cache();

}  // namespace nearlight::core
