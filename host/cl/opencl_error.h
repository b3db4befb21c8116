// SPDX-License-Identifier: Apache-2.0
// Translation of OpenCL's error codes into nearlight::Error.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {

/// The name of an error code: "CL_OUT_OF_RESOURCES" for -5, "error -9999" for a code without a name.
std::string opencl_error_name(cl_int code);

/// Makes an Error that says which call failed on what `subject` ("kernel gather on device X"). Its kind is
/// ErrorKind::out_of_memory for failed allocations, ErrorKind::failure otherwise, with the setting "device".
Error make_opencl_error(const cl::Error& error, const std::string& subject);

/// Runs `action`, returns its result, and translates a cl::Error with make_opencl_error().
template <typename Action>
auto with_opencl_errors(const std::string& subject, Action&& action) {
    try {
        return action();
    } catch (const cl::Error& error) {
        throw make_opencl_error(error, subject);
    }
}

}  // namespace nearlight::core
