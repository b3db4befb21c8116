// SPDX-License-Identifier: Apache-2.0
// The options by which a command takes its OpenCL device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/cl/device.h"
#include "host/cli/command.h"

namespace nearlight::core {

struct DeviceChoice {
    std::string device;  ///< see choose_devices()
    DeviceOptions options;
};

/// --device, --kernel-dir and --cache-dir.
void add_device_options(CLI::App& command, DeviceChoice& choice);

/// The same with a compiler that has processes of its own. They must be started before the command has
/// threads or loads a driver, so this is the first that a command does.
DeviceChoice with_compile_workers(DeviceChoice choice);

/// All devices of the list that match, with one compiler for all. Throws Error(ErrorKind::no_device).
std::vector<std::unique_ptr<Device>> open_devices(const DeviceChoice& choice, const DeviceList& list);

/// The one device that a command works on. Where several match, the first is taken and the rest are named in
/// a warning. Throws Error(ErrorKind::no_device).
std::unique_ptr<Device> open_device(const DeviceChoice& choice);

}  // namespace nearlight::core
