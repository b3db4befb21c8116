// SPDX-License-Identifier: Apache-2.0
// `nearlight info SCENE` shows what was read, what was approximated, and how much memory it takes.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_info_command(CommandLine& line);

}  // namespace nearlight::core
