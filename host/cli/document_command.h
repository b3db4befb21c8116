// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/command.h"

namespace nearlight::core {

/// `nearlight document DIR` writes man pages and completions of all commands. The build calls it; --help does
/// not list it. `line` must live as long as the command.
void add_document_command(CommandLine& line);

}  // namespace nearlight::core
