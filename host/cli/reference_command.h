// SPDX-License-Identifier: Apache-2.0
// `nearlight reference SCENE -o OUT --spp N` makes the path-traced picture to which every sampler converges.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_reference_command(CommandLine& line);

}  // namespace nearlight::core
