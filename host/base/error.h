// SPDX-License-Identifier: Apache-2.0
// The one exception type of nearlight, and the exit codes it becomes.
#pragma once

#include <stdexcept>
#include <string>

namespace nearlight {

/// Exit codes of the program; part of its command-line contract.
enum class ExitCode {
    done = 0,
    runtime = 1,        ///< anything that has no code of its own
    usage = 2,          ///< unknown option, bad value
    file = 3,           ///< scene or image file: missing, broken, unwritable
    no_device = 4,      ///< no usable OpenCL device
    kernel_build = 5,   ///< a kernel did not compile
    out_of_memory = 6,  ///< on the host or the device
    interrupted = 130,  ///< Ctrl-C; the partial image was saved
};

/// Owns its text. The message is one line: what failed, on what (file:line, device, kernel), what to do.
/// It is caught once, in main(), which prints it and returns its code.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

}  // namespace nearlight
