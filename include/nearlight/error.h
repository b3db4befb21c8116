// SPDX-License-Identifier: Apache-2.0
// The exception that nearlight throws.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "nearlight/export.h"

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
class NEARLIGHT_API Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message, std::string_view setting = {})
        : std::runtime_error(message),
          kind_(kind),
          setting_(setting.empty() ? nullptr : std::make_shared<const std::string>(setting)) {}
    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
    /// The setting to change, as the library spells it ("kernel_dir", "strict"), so that a program can name
    /// its own option or button for it; empty if no single setting is to blame. Valid as long as the error or
    /// a copy of it.
    [[nodiscard]] std::string_view setting() const noexcept {
        return setting_ ? std::string_view(*setting_) : std::string_view();
    }

  private:
    ErrorKind kind_;
    std::shared_ptr<const std::string> setting_;  // copies of the error share it, since they may not throw
};

}  // namespace nearlight
