// SPDX-License-Identifier: Apache-2.0
// Man pages of the program and its commands.
#pragma once

#include <string>
#include <vector>

#include "host/cli/command_facts.h"

namespace nearlight::core {

struct ManPage {
    std::string file;  ///< as in "nearlight-render.1"
    std::string text;  ///< in the language of man(7)
};

/// A page for the program and one for each command below it.
std::vector<ManPage> man_pages(const CommandFacts& program, const std::string& version);

}  // namespace nearlight::core
