// SPDX-License-Identifier: Apache-2.0
// nearlight bench PART: how fast the parts are, beside the best that others offer.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_command(CommandLine& line);

}  // namespace nearlight::core
