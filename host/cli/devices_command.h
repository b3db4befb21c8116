// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// `nearlight devices`: what OpenCL offers here, what is used, and why.
void add_devices_command(CommandLine& line);

}  // namespace nearlight::core
