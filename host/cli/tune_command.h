// SPDX-License-Identifier: Apache-2.0
// nearlight tune: finds how work is best divided for a device, and keeps it for all further runs.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_tune_command(CommandLine& line);

}  // namespace nearlight::core
