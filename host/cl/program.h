// SPDX-License-Identifier: Apache-2.0
// A compiled kernel file.
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <string>

#include "host/cl/device.h"

namespace nearlight {

/// Preprocessor definitions for a program: {"SCAN_TYPE", "uint"} becomes -DSCAN_TYPE=uint.
using Defines = std::map<std::string, std::string>;

class Program {
  public:
    /// Compiles kernels/`file`, or takes it from the cache. Throws Error(ExitCode::kernel_build) with the
    /// build log's first error, and saves the expanded source and the whole log to files named in the
    /// message.
    Program(Device& device, const std::string& file, const Defines& defines = {});

    [[nodiscard]] Device& device() const { return *device_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] cl::Kernel kernel(const std::string& name) const;

  private:
    Device* device_;
    std::string file_;
    cl::Program handle_;
};

}  // namespace nearlight
