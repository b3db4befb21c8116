// SPDX-License-Identifier: Apache-2.0
// nearlight bench sort: radix sort and prefix sum, beside the host's libraries and the memory's speed.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_sort(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
