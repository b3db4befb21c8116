// SPDX-License-Identifier: Apache-2.0
// What nearlight throws.
#pragma once

#include <stdexcept>
#include <string>

namespace nearlight {

/// What kind of failure an Error reports, for callers that treat kinds differently.
enum class ErrorKind {
    failure,           ///< anything that has no kind of its own
    invalid_argument,  ///< a value that the function does not take
    file,              ///< a scene or image file is missing, broken or cannot be written
    no_device,         ///< no usable OpenCL device
    kernel_build,      ///< a kernel did not compile
    out_of_memory,     ///< on the host or on a device
};

/// The only exception type of nearlight, besides what the standard library throws. what() is one line: what
/// failed, on what (file and line, device, kernel), and what to do.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

  private:
    ErrorKind kind_;
};

}  // namespace nearlight
