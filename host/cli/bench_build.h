// SPDX-License-Identifier: Apache-2.0
// `nearlight bench build` compares our trees with Embree's.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_build(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
