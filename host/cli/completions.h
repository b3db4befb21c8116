// SPDX-License-Identifier: Apache-2.0
// Scripts by which shells complete the program's commands, options and values.
#pragma once

#include <string>

#include "host/cli/command_facts.h"

namespace nearlight::core {

std::string bash_completion(const CommandFacts& program);
std::string zsh_completion(const CommandFacts& program);
std::string fish_completion(const CommandFacts& program);

}  // namespace nearlight::core
