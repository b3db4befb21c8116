// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nearlight::core {

/// Gives PoCL a temporary folder for its files, which goes when the process ends, if the one that it would
/// take cannot be written: it then has no device, or ends the process. Does nothing if POCL_CACHE_DIR is set.
/// It sets that variable, so no other thread may run yet.
void ensure_driver_cache();

}  // namespace nearlight::core
