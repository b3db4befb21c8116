// SPDX-License-Identifier: Apache-2.0
// nearlight reference SCENE -o OUT --spp N: the path-traced picture that every sampler converges to.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_reference_command(CommandLine& line);

}  // namespace nearlight::core
