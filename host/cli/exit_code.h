// SPDX-License-Identifier: Apache-2.0
// The exit codes of the program, which scripts rely on.
#pragma once

#include "nearlight/error.h"

namespace nearlight::core {

enum class ExitCode {
    done = 0,
    runtime = 1,        ///< any error without a code of its own
    usage = 2,          ///< unknown option, bad value
    file = 3,           ///< scene or image file: missing, broken, unwritable
    no_device = 4,      ///< no usable OpenCL device
    kernel_build = 5,   ///< a kernel did not compile
    out_of_memory = 6,  ///< on the host or the device
    interrupted = 130,  ///< Ctrl-C; what a render had made of its picture was saved
};

/// The code that main() returns for an Error of the given kind.
constexpr ExitCode exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::failure:
            return ExitCode::runtime;
        case ErrorKind::invalid_argument:
            return ExitCode::usage;
        case ErrorKind::file:
            return ExitCode::file;
        case ErrorKind::no_device:
            return ExitCode::no_device;
        case ErrorKind::kernel_build:
            return ExitCode::kernel_build;
        case ErrorKind::out_of_memory:
            return ExitCode::out_of_memory;
    }
    return ExitCode::runtime;
}

}  // namespace nearlight::core
