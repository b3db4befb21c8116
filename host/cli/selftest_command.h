// SPDX-License-Identifier: Apache-2.0
// `nearlight selftest` compares every kernel with its oracle on the host, on the devices of --device.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_selftest_command(CommandLine& line);

}  // namespace nearlight::core
