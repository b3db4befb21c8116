// SPDX-License-Identifier: Apache-2.0
// The command line, up to where a command would run.
#include <iostream>
#include <string>
#include <vector>

#include "host/base/words.h"
#include "host/cli/commands.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

void fuzz_command_line(Bytes bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::vector<std::string> words = split(text.substr(0, text.find('\0')), '\n');
    std::vector<const char*> arguments{"nearlight"};
    for (const std::string& word : words) {
        arguments.push_back(word.c_str());
    }
    std::cout.setstate(std::ios::failbit);  // nobody reads the help
    std::cerr.setstate(std::ios::failbit);
    // Making the options takes a hundred times as long as parsing. A parser forgets earlier lines.
    static CommandLine line;
    static const bool has_commands = (add_commands(line), true);
    static_cast<void>(has_commands);
    try {
        static_cast<void>(line.parse(static_cast<int>(arguments.size()), arguments.data()));
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
