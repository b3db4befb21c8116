// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// `nearlight render SCENE -o OUT` renders a picture with virtual point lights.
void add_render_command(CommandLine& line);

}  // namespace nearlight::core
