// SPDX-License-Identifier: Apache-2.0
#include "host/cli/command_facts.h"
#include "host/base/words.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace nearlight::core {
namespace {

/// Whether the word stands for a file or a folder in --help.
bool is_file_value(std::string_view word) {
    constexpr std::array<std::string_view, 7> kFileValues{"OUT", "MAP", "FILE", "DIR", "SCENE", "A", "B"};
    return std::ranges::find(kFileValues, word) != kFileValues.end();
}

/// The words that may be given as they stand where the name of a type shows several kinds of values, as in
/// "FILE|sky|COLOR". Capitals stand for what they name.
std::vector<std::string> choices_among(const std::string& type) {
    std::vector<std::string> words = split(type, '|');
    if (words.size() == 1) {
        return {};
    }
    std::erase_if(words, [](const std::string& word) {
        return word.empty() || !std::ranges::all_of(word, [](char c) { return c >= 'a' && c <= 'z'; });
    });
    return words;
}

/// The choices that stand behind the name of a type, as in "NAME:{packets,rays}" of add_choice(), or
/// "on|off:{on,off}" and, where words stand for numbers, "NAME:{fast->0,slow->1} OR {0,1}" of the parser.
std::vector<std::string> choices_in(const std::string& type) {
    const std::size_t open = type.find('{');
    const std::size_t close = type.find('}', open);
    if (open == std::string::npos || close == std::string::npos) {
        return {};
    }
    std::vector<std::string> words = split(type.substr(open + 1, close - open - 1), ',');
    for (std::string& word : words) {
        word = word.substr(0, word.find("->"));
    }
    return words;
}

OptionFacts option_facts(const CLI::Option& option) {
    OptionFacts facts{.description = option.get_description(),
                      .default_value = option.get_default_str(),
                      .group = option.get_group(),
                      .is_positional = option.get_positional(),
                      .is_required = option.get_required()};
    if (facts.is_positional) {
        facts.names.push_back(option.get_name(true, false));
    } else {
        for (const std::string& name : option.get_snames()) {
            facts.names.push_back("-" + name);
        }
        for (const std::string& name : option.get_lnames()) {
            facts.names.push_back("--" + name);
        }
    }
    facts.is_repeated = option.get_items_expected_max() > 1;
    const bool has_value = facts.is_positional || option.get_items_expected_max() > 0;
    if (has_value) {
        facts.choices = choices_in(option.get_type_name());
        facts.value = facts.is_positional ? facts.names.front() : value_word(option);
        if (facts.choices.empty()) {
            facts.choices = choices_among(facts.value);
        }
        facts.takes_file = std::ranges::any_of(split(facts.value, '|'), is_file_value);
    }
    return facts;
}

CommandFacts facts_below(const CLI::App& command, const std::string& parents) {
    CommandFacts facts{.name = command.get_name(),
                       .full_name = parents + command.get_name(),
                       .description = command.get_description()};
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_group().empty()) {
            facts.options.push_back(option_facts(*option));
        }
    }
    for (const CLI::App* part : command.get_subcommands(is_listed)) {
        facts.parts.push_back(facts_below(*part, facts.full_name + " "));
    }
    return facts;
}

}  // namespace

// The parser's name of a type goes on behind a colon with what the value must be. A colon between brackets
// belongs to the word.
std::string value_word(const CLI::Option& option) {
    if (option.get_type_size() == 0) {
        return "";
    }
    std::string word = option.get_type_name();
    int depth = 0;
    const auto ends = [&](char c) {
        depth += (c == '[') - (c == ']');
        return c == ':' && depth == 0;
    };
    word.erase(std::ranges::find_if(word, ends), word.end());
    return word;
}

CommandFacts command_facts(const CLI::App& command) {
    return facts_below(command, "");
}

}  // namespace nearlight::core
