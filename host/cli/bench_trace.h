// SPDX-License-Identifier: Apache-2.0
// `nearlight bench trace` compares our closest hits with Embree's on camera rays and rays of walks.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_trace(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
