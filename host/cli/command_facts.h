// SPDX-License-Identifier: Apache-2.0
// What the parser knows about commands and options, as plain data: man pages and completions are made of it,
// so that they say what --help says.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace nearlight::core {

struct OptionFacts {
    /// With their dashes, short ones first; one without dashes if it is positional.
    std::vector<std::string> names{};
    std::string value{};  ///< value_word(), but the name if it is positional
    /// The words that it takes; empty if they cannot be listed. Where it takes_file too, it takes other
    /// words.
    std::vector<std::string> choices{};
    std::string description;
    std::string default_value;  ///< empty if there is none
    std::string group;          ///< the heading above it in --help
    bool is_positional = false;
    bool is_required = false;
    bool is_repeated = false;  ///< takes several values
    bool takes_file = false;   ///< the value names a file or a folder

    [[nodiscard]] bool is_flag() const { return value.empty() && !is_positional; }
};

struct CommandFacts {
    std::string name;       ///< the last word
    std::string full_name;  ///< all words, as in "nearlight bench gather"
    std::string description;
    std::vector<OptionFacts> options{};
    std::vector<CommandFacts> parts{};  ///< commands that belong to this one; hidden ones are left out
};

/// What stands for the option's value in --help, as in "N" or "A[:B]"; empty for a flag.
std::string value_word(const CLI::Option& option);

CommandFacts command_facts(const CLI::App& command);

/// Whether --help of the parent lists the command.
inline bool is_listed(const CLI::App* command) {
    return !command->get_group().empty();
}

}  // namespace nearlight::core
