// SPDX-License-Identifier: Apache-2.0
// nearlight bench gather: one set of shadow rays, through our kernels and through Embree in all its modes.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_gather(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
