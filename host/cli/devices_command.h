// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// `nearlight devices` lists the OpenCL devices, which of them are used, and why.
void add_devices_command(CommandLine& line);

}  // namespace nearlight::core
