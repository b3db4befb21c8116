// SPDX-License-Identifier: Apache-2.0
// The frame of the command line. To add a command `foo`:
//  1. foo_command.h declares `void add_foo_command(CommandLine& line);`
//  2. foo_command.cpp has a struct FooOptions with defaults and an `ExitCode run_foo(const FooOptions&, const
//     GlobalOptions&)`; add_foo_command() makes the options shared, calls line.add_command("foo", "what it
//     does", [options](const GlobalOptions& global) { return run_foo(*options, global); }) and declares the
//     options on the CLI::App that this returns. diff_command.cpp shows it.
//  3. host/cli/CMakeLists.txt lists the file, main.cpp calls add_foo_command().
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "host/cli/exit_code.h"

namespace nearlight::core {

/// What every command takes, besides --help and --version.
struct GlobalOptions {
    bool json = false;     ///< one JSON object on standard output, nothing else there; see output.h
    bool quiet = false;    ///< errors only
    bool verbose = false;  ///< debug messages too
};

class CommandLine {
  public:
    using Run = std::function<ExitCode(const GlobalOptions&)>;

    CommandLine();
    /// A command that takes the global options; declare its own on what this returns. `run` is called once
    /// the whole line is known to be right.
    CLI::App& add_command(const std::string& name, const std::string& description, Run run);
    /// A command that only names its parts, as `bench` does.
    CLI::App& add_command_group(const std::string& name, const std::string& description);
    /// The same as add_command() for `part` of such a group.
    CLI::App& add_part(CLI::App& group, const std::string& part, const std::string& description, Run run);
    /// Parses the line and runs its command. Throws Error(ErrorKind::invalid_argument) with a hint for a
    /// wrong line, and whatever the command throws.
    ExitCode run(int argc, const char* const* argv);

  private:
    CLI::App app_;
    GlobalOptions global_;
    Run run_;  ///< of the command that the line names
};

struct ImageSize {
    int width = 0;
    int height = 0;
};
/// "640x480"; each side from 1 to 65536. Throws Error(ErrorKind::invalid_argument).
ImageSize parse_size(const std::string& text);
/// The option --size, which leaves `size` alone where it is not given.
CLI::Option* add_size_option(CLI::App& command, ImageSize& size);

}  // namespace nearlight::core
