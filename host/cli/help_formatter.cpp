// SPDX-License-Identifier: Apache-2.0
#include "host/cli/help_formatter.h"

#include <sstream>

#include "host/cli/command_facts.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kLineWidth = 100;
constexpr std::size_t kNameWidth = 30;

/// The text with line breaks between words, so that no line but the first one begins before the column
/// `indent`, and none ends behind kLineWidth. The first line begins at `column`.
std::string wrapped(const std::string& text, std::size_t column, std::size_t indent) {
    std::istringstream words(text);
    std::string result;
    std::string word;
    for (bool is_first = true; words >> word; is_first = false) {
        if (!is_first && column + 1 + word.size() > kLineWidth) {
            result += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (!is_first) {
            result += " ";
            ++column;
        }
        result += word;
        column += word.size();
    }
    return result;
}

/// A name, and behind or below it what it stands for.
std::string entry(const std::string& name, const std::string& description) {
    std::string text = "  " + name;
    if (text.size() + 1 > kNameWidth) {
        text += "\n" + std::string(kNameWidth, ' ');
    } else {
        text.resize(kNameWidth, ' ');
    }
    return text + wrapped(description, kNameWidth, kNameWidth) + "\n";
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
    return entry(make_option_name(option, is_positional) + make_option_opts(option),
                 make_option_desc(option));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    return entry(command->get_name(), command->get_description());
}

/// The word for the value, and the default. What a value may be is said by the description, or by the error
/// that a wrong one gives.
std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
    const std::string value = value_word(*option);
    const std::string fallback = option->get_default_str();
    return (value.empty() ? "" : " " + value) + (fallback.empty() ? "" : " [" + fallback + "]");
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
    return wrapped(CLI::Formatter::make_description(app), 0, 0) + "\n";
}

}  // namespace nearlight::core
