// SPDX-License-Identifier: Apache-2.0
// The options by which a command chooses its OpenCL device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/cl/device.h"
#include "host/cli/command.h"

namespace nearlight::core {

/// What help says of the cache folder; see default_cache_dir().
inline constexpr const char* kDefaultCacheText =
    "The default is $NEARLIGHT_CACHE_DIR, or else nearlight in $XDG_CACHE_HOME, or else ~/.cache/nearlight";

struct DeviceChoice {
    std::string device;  ///< see choose_devices()
    DeviceOptions options;
};

/// Adds --device, --kernel-dir and --cache-dir.
void add_device_options(CLI::App& command, DeviceChoice& choice);

/// Warns if a file stands where the cache folder should be, because nothing is kept then.
void warn_of_cache_file(const DeviceChoice& choice);

/// The choice with a compiler that has its own processes, for which the environment that drivers read is set.
/// They must be started before the command has threads or loads a driver, so a command calls this first.
/// Warns as warn_of_cache_file() does.
DeviceChoice with_compile_workers(DeviceChoice choice);

/// Opens all devices of the list that match, with one compiler for all. Throws Error(ErrorKind::no_device) if
/// none matches.
std::vector<std::unique_ptr<Device>> open_devices(const DeviceChoice& choice, const DeviceList& list);

/// Opens the first device that matches. A warning names it if several match. Throws
/// Error(ErrorKind::no_device) if none matches.
std::unique_ptr<Device> open_device(const DeviceChoice& choice);

}  // namespace nearlight::core
