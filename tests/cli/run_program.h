// SPDX-License-Identifier: Apache-2.0
// Runs the real program in a shell.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {

struct ProgramResult {
    int exit_code = -1;
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
};

inline std::string file_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the program. `arguments`, and the text before the program, such as `VARIABLE=value`, are words of a
/// shell command line and may have redirections.
inline ProgramResult run_program(const std::string& arguments, const std::string& before = "") {
    const TemporaryFolder folder;
    const std::string command = before + " " + NEARLIGHT_PROGRAM + " >" + (folder / "output").string() +
                                " 2>" + (folder / "errors").string() + " " + arguments;
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(folder / "output"),
            file_text(folder / "errors")};
}

/// Runs the program and presses Ctrl-C after `seconds`. If it had not `begun` by then, it runs again with
/// twice the time, because other load may delay it.
template <typename Begun>
ProgramResult run_interrupted(const std::string& arguments, double seconds, const Begun& begun) {
    constexpr double kMax = 128;
    for (;; seconds *= 2) {
        // The program must be in the foreground, because `timeout` would otherwise also interrupt its whole
        // group, and a second interrupt ends the program.
        ProgramResult result = run_program(
            arguments, "timeout --foreground --preserve-status --signal=INT " + std::to_string(seconds));
        if (begun(result) || result.exit_code != 130 || seconds > kMax) {
            return result;
        }
    }
}

/// A path as a word of the shell.
inline std::string quoted(const std::filesystem::path& path) {
    return std::string("'").append(path.string()).append("'");
}

}  // namespace nearlight::core
