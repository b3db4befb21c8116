// SPDX-License-Identifier: Apache-2.0
// `nearlight bench sort` compares radix sort and prefix sum with the host's libraries and the memory's speed.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_sort(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
