// SPDX-License-Identifier: Apache-2.0
// `nearlight bench gather` traces one set of shadow rays with our kernels and with all modes of Embree.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_gather(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
