// SPDX-License-Identifier: Apache-2.0
#include "host/cli/completions.h"
#include "host/base/words.h"

#include <algorithm>
#include <functional>

namespace nearlight::core {
namespace {

constexpr const char* kMadeBy = "# Made from the options of the program.\n";

std::string words_of(const std::vector<std::string>& words) {
    return joined(words, " ");
}

/// Calls `visit` with every command that has no parts, and with those that have.
void visit_commands(const CommandFacts& command, const std::function<void(const CommandFacts&)>& visit) {
    visit(command);
    for (const CommandFacts& part : command.parts) {
        visit_commands(part, visit);
    }
}

std::vector<std::string> part_names(const CommandFacts& command) {
    std::vector<std::string> names;
    for (const CommandFacts& part : command.parts) {
        names.push_back(part.name);
    }
    return names;
}

std::vector<std::string> option_words(const CommandFacts& command) {
    std::vector<std::string> names;
    for (const OptionFacts& option : command.options) {
        if (!option.is_positional) {
            names.insert(names.end(), option.names.begin(), option.names.end());
        }
    }
    return names;
}

/// The beginning of a description, up to where details follow: what fits in a menu.
std::string brief(const std::string& description) {
    std::size_t end = description.size();
    for (const char* const detail : {". ", "; ", ": ", " ("}) {
        end = std::min(end, description.find(detail));
    }
    return description.substr(0, end);
}

/// Text in single quotes for zsh and fish, in which `quote` stands for a quote.
std::string quoted_text(const std::string& text, const std::string& quote) {
    std::string result = "'";
    for (const char c : text) {
        result += c == '\'' ? quote : c == '\\' ? "\\\\" : std::string(1, c);
    }
    return result + "'";
}

std::string bash_values(const CommandFacts& command) {
    std::string text;
    for (const OptionFacts& option : command.options) {
        if (option.is_positional || option.is_flag()) {
            continue;
        }
        std::vector<std::string> values = option.choices;
        if (option.takes_file) {
            values.insert(values.begin(), "@files");
        }
        for (const std::string& name : option.names) {
            text +=
                "        '" + command.full_name + " " + name + "') values='" + words_of(values) + "' ;;\n";
        }
    }
    return text;
}

/// A line of _arguments for one option.
std::string zsh_option(const OptionFacts& option) {
    // Colons and brackets have a meaning there.
    std::string title = brief(option.description);
    for (const char c : {'[', ']'}) {
        std::erase(title, c);
    }
    const std::string words = words_of(option.choices);
    std::string action = words.empty() ? " " : "(" + words + ")";
    if (option.takes_file) {
        action = words.empty() ? "_files" : "{_files; compadd -- " + words + "}";
    }
    const std::string stars = option.is_repeated ? "*" : "";
    std::string text;
    for (const std::string& name : option.names) {
        const std::string value = option.is_flag() ? "" : ":" + option.value + ":" + action;
        text += " \\\n        " + quoted_text(option.is_positional ? stars + ":" + option.value + ":" + action
                                                                   : "*" + name + "[" + title + "]" + value,
                                              "'\\''");
    }
    return text;
}

std::string function_name(const CommandFacts& command) {
    std::string name = "_" + command.full_name;
    for (char& c : name) {
        c = c == ' ' || c == '-' ? '_' : c;
    }
    return name;
}

std::string zsh_group(const CommandFacts& command) {
    std::string text = function_name(command) + "() {\n    local -a commands\n    commands=(\n";
    for (const CommandFacts& part : command.parts) {
        text += "        " + quoted_text(part.name + ":" + brief(part.description), "'\\''") + "\n";
    }
    text += "    )\n    _arguments -C";
    for (const OptionFacts& option : command.options) {
        text += zsh_option(option);
    }
    text +=
        " \\\n        '1:command:->command' '*::argument:->arguments'\n"
        "    case $state in\n    command) _describe command commands ;;\n    arguments)\n"
        "        case $words[1] in\n";
    for (const CommandFacts& part : command.parts) {
        text += "        " + part.name + ") " + function_name(part) + " ;;\n";
    }
    return text + "        esac\n        ;;\n    esac\n}\n\n";
}

std::string zsh_command(const CommandFacts& command) {
    std::string text = function_name(command) + "() {\n    _arguments";
    for (const OptionFacts& option : command.options) {
        text += zsh_option(option);
    }
    return text + "\n}\n\n";
}

/// The condition under which fish offers the options of a command: its words were given, and none of its
/// parts.
std::string fish_condition(const CommandFacts& command) {
    std::vector<std::string> words = split(command.full_name, ' ');
    words.erase(words.begin());
    const std::string text = joined(
        words, "; and ", [](const std::string& word) { return "__fish_seen_subcommand_from " + word; });
    return command.parts.empty()
               ? text
               : text + "; and not __fish_seen_subcommand_from " + words_of(part_names(command));
}

std::string fish_option(const OptionFacts& option, const std::string& condition) {
    std::string text = "complete -c nearlight -n '" + condition + "'";
    for (const std::string& name : option.names) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (!option.is_flag()) {
        text += option.takes_file ? " -rF" : " -x";
        text += option.choices.empty() ? "" : " -a '" + words_of(option.choices) + "'";
    }
    return text + " -d " + quoted_text(brief(option.description), "\\'") + "\n";
}

}  // namespace

std::string bash_completion(const CommandFacts& program) {
    std::string cases;
    std::string values;
    visit_commands(program, [&](const CommandFacts& command) {
        cases += "        '" + command.full_name + "') parts='" + words_of(part_names(command)) +
                 "' options='" + words_of(option_words(command)) + "' ;;\n";
        values += bash_values(command);
    });
    return kMadeBy + std::string(R"(_nearlight() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local command=nearlight parts='' options='' values='' word
    _nearlight_command
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        if [[ " $parts " == *" $word "* ]]; then
            command+=" $word"
            _nearlight_command
        fi
    done
    case "$command $previous" in
)") + values +
           R"(        *) values='@none' ;;
    esac
    if [[ $values == @none && $current != -* && -z $parts ]]; then
        values=@files
    fi
    if [[ $values == @files* ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -W "${values#@files}" -- "$current")
    elif [[ $values == @none ]]; then
        if [[ $current == -* ]]; then
            parts=$options
        fi
        mapfile -t COMPREPLY < <(compgen -W "$parts" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
    fi
}

_nearlight_command() {
    case $command in
)" + cases +
           R"(    esac
}

complete -F _nearlight nearlight
)";
}

std::string zsh_completion(const CommandFacts& program) {
    std::string text = "#compdef nearlight\n" + std::string(kMadeBy) + "\n";
    visit_commands(program, [&](const CommandFacts& command) {
        text += command.parts.empty() ? zsh_command(command) : zsh_group(command);
    });
    return text + function_name(program) + " \"$@\"\n";
}

std::string fish_completion(const CommandFacts& program) {
    std::string text = kMadeBy;
    visit_commands(program, [&](const CommandFacts& command) {
        const bool is_program = &command == &program;
        const std::string condition = is_program ? "__fish_use_subcommand" : fish_condition(command);
        for (const CommandFacts& part : command.parts) {
            text += "complete -c nearlight -f -n '" + condition + "' -a " + part.name + " -d " +
                    quoted_text(brief(part.description), "\\'") + "\n";
        }
        for (const OptionFacts& option : command.options) {
            if (!option.is_positional) {
                text += fish_option(option, condition);
            }
        }
    });
    return text;
}

}  // namespace nearlight::core
