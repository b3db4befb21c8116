// SPDX-License-Identifier: Apache-2.0
// The framework of the command line. To add a command `foo`:
//  1. foo_command.h declares `void add_foo_command(CommandLine& line);`
//  2. foo_command.cpp has a struct FooOptions with defaults and an `ExitCode run_foo(const FooOptions&, const
//     GlobalOptions&)`; add_foo_command() makes the options shared, calls line.add_command("foo", "what it
//     does", [options](const GlobalOptions& global) { return run_foo(*options, global); }) and declares the
//     options on the CLI::App that this returns. diff_command.cpp shows it.
//  3. host/cli/CMakeLists.txt lists the file, commands.cpp calls add_foo_command().
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/base/words.h"
#include "host/cli/command_facts.h"
#include "host/cli/exit_code.h"
#include "nearlight/error.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The options of every command besides --help and --version.
struct GlobalOptions {
    bool json = false;           ///< standard output gets one JSON object and nothing else; see output.h
    bool quiet = false;          ///< log only errors
    bool verbose = false;        ///< log debug messages too
    std::string command_line{};  ///< as a shell would read it, for the metadata of pictures
};

class CommandLine {
  public:
    using Run = std::function<ExitCode(const GlobalOptions&)>;

    CommandLine();
    /// Adds a command that takes the global options. The caller declares the command's own options on the
    /// returned object. `run` is called after the whole line has been checked.
    CLI::App& add_command(const std::string& name, const std::string& description, Run run);
    /// Adds a command that only groups its parts, like `bench`.
    CLI::App& add_command_group(const std::string& name, const std::string& description);
    /// Adds a command as add_command() does, but as a part of `group`.
    CLI::App& add_part(CLI::App& group, const std::string& part, const std::string& description, Run run);
    /// Parses the line, and answers --help and --version. Returns nothing if there is a command to run.
    /// Throws Error(ErrorKind::invalid_argument) with a hint if the line is wrong.
    std::optional<ExitCode> parse(int argc, const char* const* argv);
    /// Parses the line and runs its command. Throws what parse() and the command throw.
    ExitCode run(int argc, const char* const* argv);
    /// All commands and options that --help lists.
    [[nodiscard]] CommandFacts facts() const { return command_facts(app_); }

  private:
    CLI::App app_;
    GlobalOptions global_;
    Run run_;  ///< runs the command that the line names
};

/// Accepts numbers from `low` to `high`, and no NaN.
CLI::Validator number_from(double low, double high);
/// Accepts whole numbers from 0 to `high`. The parser alone takes those below 0 for very large ones.
CLI::Validator whole_number_to(std::uint64_t high);

struct ImageSize {
    int width = 0;
    int height = 0;
};
/// Parses a size such as "640x480"; each side is from 1 to 65536 pixels. Throws
/// Error(ErrorKind::invalid_argument).
ImageSize parse_size(const std::string& text);
/// Parses a part of a picture such as "320x240+100+50": its size, and its place from the left and from the
/// top. Throws Error(ErrorKind::invalid_argument).
PixelWindow parse_window(const std::string& text);
/// Parses "auto", which gives nothing, or a number in [min, max]. Throws Error(ErrorKind::invalid_argument),
/// which names the option.
std::optional<float> number_or_auto(const std::string& option, const std::string& text, float min, float max);
/// Adds the option --size, without which `size` is unchanged.
CLI::Option* add_size_option(CLI::App& command, ImageSize& size);
/// The same option where the scene's size is the default.
CLI::Option* add_scene_size_option(CLI::App& command, ImageSize& size);

/// Adds the option --seed, which takes all numbers that `seed` can hold.
template <typename Seed>
CLI::Option* add_seed_option(CLI::App& command, Seed& seed) {
    return command
        .add_option("--seed", seed, "Seed of the random numbers: the same seed gives the same picture")
        ->check(whole_number_to(std::numeric_limits<Seed>::max()))
        ->type_name("N")
        ->capture_default_str();
}

/// The error of an option whose value is none of the names that it takes.
Error unknown_choice(const std::string& option, const std::string& text, const std::string& names);

/// Adds an option that takes one of `words`, which its help shows in this order. `take` is called with the
/// word that is given. The error for any other word lists them, and completions offer them.
CLI::Option* add_words(CLI::App& command, const std::string& option, const std::vector<std::string>& words,
                       std::function<void(const std::string& word)> take, const std::string& description);

/// Adds an option whose value must be the name of a choice. The error for any other value lists the names,
/// and completions offer them. `value` is a Choice or an optional one.
template <typename Choice, typename Value>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Value& value,
                        const std::map<std::string, Choice>& choices, const std::string& description) {
    const auto names = [](const auto& choice) { return choice.first; };
    const auto choose = [option, &value, choices, names](const std::string& text) {
        const auto found = choices.find(text);
        if (found == choices.end()) {
            throw unknown_choice(option, text, joined(choices, ", ", names));
        }
        value = found->second;
    };
    return command.add_option_function<std::string>(option, choose, description)
        ->type_name("NAME:{" + joined(choices, ",", names) + "}");
}

}  // namespace nearlight::core
