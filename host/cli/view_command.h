// SPDX-License-Identifier: Apache-2.0
// `nearlight view`: a window in which one walks about in a scene.
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

void add_view_command(CommandLine& line);

}  // namespace nearlight::core
