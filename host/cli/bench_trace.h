// SPDX-License-Identifier: Apache-2.0
// nearlight bench trace: rays of the camera and of light walks, beside Embree.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_bench_trace(CommandLine& line, CLI::App& group);

}  // namespace nearlight::core
