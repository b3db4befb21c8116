// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nearlight::core {

/// Gives PoCL a temporary folder for its files, which goes when the process ends, if the one that it would
/// take cannot be written or is on a full disk: it then has no device, or ends the process. Sets
/// POCL_CACHE_DIR, so no other thread may run yet.
void ensure_driver_cache();

}  // namespace nearlight::core
