// SPDX-License-Identifier: Apache-2.0
// `nearlight bench PART` compares the speed of a part with the best alternatives.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_command(CommandLine& line);

}  // namespace nearlight::core
