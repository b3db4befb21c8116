// SPDX-License-Identifier: Apache-2.0
// `nearlight diff A B [-o MAP]` measures the difference between two pictures, layer by layer.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_diff_command(CommandLine& line);

}  // namespace nearlight::core
