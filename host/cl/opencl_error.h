// SPDX-License-Identifier: Apache-2.0
// Translation of OpenCL's error codes into nearlight::Error.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {

/// "CL_OUT_OF_RESOURCES" for -5, "error -9999" for codes that have no name.
std::string opencl_error_name(cl_int code);

/// An Error that says which call failed on what ("kernel gather on device X"), with the exit code that suits:
/// out of memory for failed allocations, runtime otherwise.
Error make_opencl_error(const cl::Error& error, const std::string& subject);

/// Runs `action` and translates cl::Error.
template <typename Action>
auto with_opencl_errors(const std::string& subject, Action&& action) {
    try {
        return action();
    } catch (const cl::Error& error) {
        throw make_opencl_error(error, subject);
    }
}

}  // namespace nearlight::core
