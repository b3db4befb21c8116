// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// `nearlight compare SCENE … -o DIR`.
void add_compare_command(CommandLine& line);

}  // namespace nearlight::core
