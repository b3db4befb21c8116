// SPDX-License-Identifier: Apache-2.0
// A kernel file, compiled in the background.
#pragma once

#include <CL/opencl.hpp>
#include <future>
#include <map>
#include <string>

#include "host/cl/device.h"

namespace nearlight::core {

/// Preprocessor definitions for a program: {"SCAN_TYPE", "uint"} becomes -DSCAN_TYPE=uint.
using Defines = std::map<std::string, std::string>;

/// A file under kernels/ that includes those of several stages, to be compiled as one program on CPUs. PoCL
/// spends 0.1 s on each program before its first line, and works on functions that stages share once for each
/// program.
struct JointProgram {
    const char* file;
};

class Program {
  public:
    /// Begins to compile kernels/`file`, or to take it from the cache, and returns at once. What the device
    /// has had compiled before is shared. Throws Error(ErrorKind::kernel_build) where there is no such file.
    Program(Device& device, const std::string& file, const Defines& defines = {});
    /// On CPUs `joint`, which must include `file`, is compiled in its place. On other devices a driver that
    /// does not compile one stage must not lose others by it, so each stage is a program of its own there.
    Program(Device& device, const std::string& file, const JointProgram& joint);

    [[nodiscard]] Device& device() const { return *device_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    /// Waits for the compiler. Throws Error(ErrorKind::kernel_build), see build_program(); Error where there
    /// is no such entry point.
    [[nodiscard]] cl::Kernel kernel(const std::string& name) const;

  private:
    Device* device_;
    std::string file_;
    std::shared_future<cl::Program> built_;
};

}  // namespace nearlight::core
