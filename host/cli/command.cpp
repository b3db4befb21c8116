// SPDX-License-Identifier: Apache-2.0
#include "host/cli/command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <regex>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/limits.h"
#include "host/base/shell_word.h"
#include "host/base/suggestion.h"
#include "host/cli/help_formatter.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/scene/number_text.h"

namespace nearlight::core {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(is_listed)) {
        names.push_back(command->get_name());
    }
    return names;
}

/// The heading above commands in --help.
constexpr const char* kCommandGroup = "Commands";

/// What other renderers call an option.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOthersNames{
    {{"--width", "--size"},
     {"--height", "--size"},
     {"--resolution", "--size"},
     {"--samples", "--spp"},
     {"--bounces", "--max-depth"},
     {"--envmap", "--environment"},
     {"--lights", "--vpls"}}};

std::string unknown(const char* kind, const std::string& word, const std::vector<std::string>& words) {
    const auto* const other =
        std::ranges::find(kOthersNames, word, [](const auto& names) { return names.first; });
    const bool is_known = other != kOthersNames.end() && std::ranges::count(words, other->second) > 0;
    const std::string nearest = is_known ? std::string(other->second) : nearest_word(word, words);
    return std::string("unknown ") + kind + " '" + word + "'" +
           (nearest.empty() ? "" : ", did you mean '" + nearest + "'?");
}

/// The command or the part that the line names; the program itself if it names none.
const CLI::App& named_command(const CLI::App& app) {
    const CLI::App* command = &app;
    for (auto next = command->get_subcommands(); !next.empty(); next = command->get_subcommands()) {
        command = next.front();
    }
    return *command;
}

/// The command with those that it belongs to, such as "nearlight bench gather".
std::string full_name(const CLI::App& command) {
    const CLI::App* const parent = command.get_parent();
    return (parent != nullptr ? full_name(*parent) + " " : std::string()) + command.get_name();
}

/// What is said instead of what the parser says.
std::string reworded(const std::string& text) {
    constexpr std::size_t kMaxLength = 1000;  // std::regex goes one call deeper with each letter
    if (text.size() > kMaxLength) {
        return text;
    }
    const std::pair<std::regex, const char*> kWordings[] = {
        {std::regex("(.*): 1 required (.*) missing"), "$1 needs a value, $2"},
        {std::regex("(.*): At Most 1 required but received (.*)"), "$1 is given $2 times; give it once"},
        // CLI11 2.1 writes the ends of a range as in "1 to 9", and 2.4 as in "[1 - 9]".
        {std::regex(R"((.*): Value (.*) not in range \[?([0-9]+)(?: to | - )([0-9]+)\]?)"),
         "$1: '$2' is no whole number from $3 to $4"},
        {std::regex(R"((.*): Value (.*) not in range \[?(.*)(?: to | - )([^\]]*)\]?)"),
         "$1: '$2' is no number from $3 to $4"},
        {std::regex("Could not convert: (.*) = (.*)"), "$1: '$2' is no number"}};
    for (const auto& [pattern, wording] : kWordings) {
        if (std::regex_match(text, pattern)) {
            return std::regex_replace(text, pattern, wording);
        }
    }
    return text;
}

/// Describes what is wrong with the line. An unknown word comes first, because it often causes the other
/// errors.
std::string describe(const CLI::ParseError& error, const CLI::App& app, const CLI::App& command) {
    const std::vector<std::string> extras = app.remaining(true);
    const auto is_option = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
    const auto option = std::find_if(extras.begin(), extras.end(), is_option);
    if (option != extras.end()) {
        return unknown("option", option->substr(0, option->find('=')), option_names(command));
    }
    std::error_code ignored;
    if (!extras.empty() && &command == &app && std::filesystem::exists(extras.front(), ignored)) {
        return "'" + extras.front() + "' is a file; say what to do with it, as in: nearlight render " +
               shell_word(extras.front());
    }
    if (!extras.empty() && !command_names(command).empty()) {
        return unknown("command", extras.front(), command_names(command));
    }
    if (!extras.empty()) {
        return "unexpected argument '" + extras.front() + "'";
    }
    if (std::string_view(error.what()) == "A subcommand is required") {
        return full_name(command) + " needs one of these commands: " + joined(command_names(command), ", ");
    }
    return reworded(error.what());
}

/// The line with which the program was called.
std::string command_line_of(int argc, const char* const* argv) {
    std::string line = "nearlight";
    for (int i = 1; i < argc; ++i) {
        line += " " + shell_word(argv[i]);
    }
    return line;
}

/// An error of one line, which says what is wrong and where to read more.
Error usage_error(const CLI::ParseError& error, const CLI::App& app) {
    const CLI::App& command = named_command(app);
    std::string text = describe(error, app, command);
    std::replace(text.begin(), text.end(), '\n', ' ');
    const std::string help = full_name(command) + " --help";
    return {ErrorKind::invalid_argument, text + (text.back() == '?' ? " See '" : "; see '") + help + "'"};
}

/// Throws if an option or an argument of the command is given an empty value, as by a variable of a script
/// that is not set. Commands would take it for one that is not given.
void refuse_empty_values(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        const bool has_empty =
            std::ranges::any_of(option->results(), [](const std::string& value) { return value.empty(); });
        if (has_empty) {
            const std::string needs =
                option->get_positional() ? "" : ", but needs a value, " + option->get_type_name();
            throw Error(ErrorKind::invalid_argument, option->get_name() + " is empty" + needs + "; see '" +
                                                         full_name(command) + " --help'");
        }
    }
}

std::string short_usage(const CLI::App& app) {
    std::string text = "usage: nearlight COMMAND ...\n\n";
    for (const CLI::App* command : app.get_subcommands(is_listed)) {
        std::string name = command->get_name();
        name.resize(12, ' ');
        text += "  " + name + command->get_description() + "\n";
    }
    return text + "\nRun 'nearlight COMMAND --help' for the options of a command.\n";
}

void add_global_options(CLI::App& app, GlobalOptions& global) {
    const std::string group = "Common options";
    app.set_help_flag("-h,--help", "Show this help and exit")->group(group);
    app.set_version_flag("--version", "nearlight " NEARLIGHT_VERSION, "Show the version and exit")
        ->group(group);
    app.add_flag("--json", global.json, "Print the result to standard output as one JSON object")
        ->group(group);
    app.add_flag("-q,--quiet", global.quiet, "Print only errors")->group(group);
    app.add_flag("-v,--verbose", global.verbose, "Also print debug messages")->group(group);
}

}  // namespace

CommandLine::CommandLine() : app_("Global illumination with virtual point lights on OpenCL", "nearlight") {
    app_.formatter(std::make_shared<HelpFormatter>());  // commands take it over from here
    add_global_options(app_, global_);
    app_.require_subcommand(0, 1);
}

CLI::App& CommandLine::add_command(const std::string& name, const std::string& description, Run run) {
    return add_part(app_, name, description, std::move(run));
}

CLI::App& CommandLine::add_command_group(const std::string& name, const std::string& description) {
    CLI::App& group = *app_.add_subcommand(name, description)->group(kCommandGroup);
    add_global_options(group, global_);
    group.require_subcommand(1);
    return group;
}

CLI::App& CommandLine::add_part(CLI::App& group, const std::string& part, const std::string& description,
                                Run run) {
    CLI::App& command = *group.add_subcommand(part, description)->group(kCommandGroup);
    add_global_options(command, global_);
    command.callback([this, run = std::move(run)] { run_ = run; });
    return command;
}

std::optional<ExitCode> CommandLine::parse(int argc, const char* const* argv) {
    try {
        app_.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help and --version
        std::signal(SIGPIPE, SIG_DFL);       // a reader such as `head` may have seen enough
        app_.exit(success, std::cout, std::cerr);
        check_standard_output();
        return ExitCode::done;
    } catch (const CLI::ParseError& error) {
        throw usage_error(error, app_);
    }
    if (!run_) {
        std::cerr << short_usage(app_);
        return ExitCode::usage;
    }
    refuse_empty_values(named_command(app_));
    if (global_.quiet && global_.verbose) {
        throw Error(ErrorKind::invalid_argument,
                    "--quiet and --verbose contradict each other; give only one of them");
    }
    return std::nullopt;
}

ExitCode CommandLine::run(int argc, const char* const* argv) {
    if (const std::optional<ExitCode> answered = parse(argc, argv)) {
        return *answered;
    }
    set_up_log(global_.quiet ? Verbosity::quiet : global_.verbose ? Verbosity::verbose : Verbosity::normal);
    global_.command_line = command_line_of(argc, argv);
    const ExitCode code = run_(global_);
    check_standard_output();
    return code;
}

PixelWindow parse_window(const std::string& text) {
    PixelWindow window;
    const std::size_t plus = text.find('+');
    const char* const end = text.data() + text.size();
    const char* const place = plus == std::string::npos ? end : text.data() + plus + 1;
    const auto [middle, x_error] = std::from_chars(place, end, window.x);
    const bool has_plus = x_error == std::errc() && middle != end && *middle == '+';
    const auto [last, y_error] = std::from_chars(has_plus ? middle + 1 : end, end, window.y);
    if (!has_plus || y_error != std::errc() || last != end) {
        throw Error(
            ErrorKind::invalid_argument,
            "'" + text + "' is not a part of a picture; give WIDTHxHEIGHT+LEFT+TOP, as in 320x240+100+50",
            "crop");
    }
    const ImageSize size = parse_size(text.substr(0, plus));
    window.width = static_cast<uint>(size.width);
    window.height = static_cast<uint>(size.height);
    return window;
}

ImageSize parse_size(const std::string& text) {
    ImageSize size;
    const char* const end = text.data() + text.size();
    const auto [middle, width_error] = std::from_chars(text.data(), end, size.width);
    const bool has_x = width_error == std::errc() && middle != end && *middle == 'x';
    const auto [last, height_error] = std::from_chars(has_x ? middle + 1 : end, end, size.height);
    const auto fits = [](int side) { return side >= 1 && side <= kMaxPictureSide; };
    if (!has_x || height_error != std::errc() || last != end || !fits(size.width) || !fits(size.height)) {
        throw Error(ErrorKind::invalid_argument, "'" + text +
                                                     "' is not a size; give WIDTHxHEIGHT, each from 1 to " +
                                                     std::to_string(kMaxPictureSide) + ", as in 640x480");
    }
    return size;
}

std::optional<float> number_or_auto(const std::string& option, const std::string& text, float min,
                                    float max) {
    if (text == "auto") {
        return std::nullopt;
    }
    const std::optional<double> value = number_in(text);
    if (!value || !(*value >= double{min} && *value <= double{max})) {
        throw Error(
            ErrorKind::invalid_argument,
            fmt::format("{} must be `auto` or a number from {:g} to {:g}, not '{}'", option, min, max, text));
    }
    return static_cast<float>(*value);
}

CLI::Option* add_size_option(CLI::App& command, ImageSize& size) {
    return command
        .add_option_function<std::string>(
            "--size", [&size](const std::string& text) { size = parse_size(text); },
            "Size of the picture, in pixels")
        ->type_name("WxH");
}

CLI::Option* add_scene_size_option(CLI::App& command, ImageSize& size) {
    return add_size_option(command, size)
        ->description("Size of the picture, in pixels (default: the scene's)");
}

Error unknown_choice(const std::string& option, const std::string& text, const std::string& names) {
    return {ErrorKind::invalid_argument, "unknown " + option + " '" + text + "'; choose one of: " + names};
}

CLI::Option* add_words(CLI::App& command, const std::string& option, const std::vector<std::string>& words,
                       std::function<void(const std::string& word)> take, const std::string& description) {
    const auto choose = [option, words, take = std::move(take)](const std::string& text) {
        if (std::ranges::find(words, text) == words.end()) {
            throw unknown_choice(option, text, joined(words, ", "));
        }
        take(text);
    };
    return command.add_option_function<std::string>(option, choose, description)
        ->type_name(joined(words, "|"));
}

CLI::Validator whole_number_to(std::uint64_t high) {
    return CLI::Validator(
        [high](const std::string& text) {
            std::uint64_t value = 0;
            const bool is_number = text.find('-') == std::string::npos &&
                                   CLI::detail::lexical_cast(text, value) && value <= high;
            return is_number ? std::string()
                             : fmt::format("'{}' is no whole number from 0 to {}", text, high);
        },
        "");
}

CLI::Validator number_from(double low, double high) {
    return CLI::Validator(
        [low, high](const std::string& text) {
            double value = NAN;
            const bool is_number = CLI::detail::lexical_cast(text, value);
            return is_number && value >= low && value <= high
                       ? std::string()
                       : fmt::format("'{}' is no number from {:g} to {:g}", text, low, high);
        },
        "");
}

}  // namespace nearlight::core
