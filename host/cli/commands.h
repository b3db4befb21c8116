// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// Adds all commands of the program.
void add_commands(CommandLine& line);

}  // namespace nearlight::core
