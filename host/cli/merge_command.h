// SPDX-License-Identifier: Apache-2.0
// `nearlight merge`: adds up the passes of jobs that worked on one picture.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_merge_command(CommandLine& line);

}  // namespace nearlight::core
