// SPDX-License-Identifier: Apache-2.0
// `nearlight tune` finds the best tunables of a device and stores them for all later runs.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_tune_command(CommandLine& line);

}  // namespace nearlight::core
