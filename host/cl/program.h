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

/// A file under kernels/ that includes the files of several stages, which CPUs compile as one program. PoCL
/// spends 0.1 s on each program before its first line, and compiles functions that stages share once per
/// program.
struct JointProgram {
    const char* file;
};

class Program {
  public:
    /// Begins to compile kernels/`file`, or to load it from the cache, and returns at once. Equal programs of
    /// one device are compiled once. Throws Error(ErrorKind::kernel_build) if there is no such file.
    Program(Device& device, const std::string& file, const Defines& defines = {});
    /// Compiles `joint`, which must include `file`, on CPUs, and `file` on other devices. If a driver of
    /// these fails to compile one stage, the other stages are not lost, because each is a program of its own.
    Program(Device& device, const std::string& file, const JointProgram& joint);

    [[nodiscard]] Device& device() const { return *device_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    /// Waits for the compiler and returns the entry point `name`. Throws Error(ErrorKind::kernel_build) as
    /// build_program() does, and Error if there is no such entry point.
    [[nodiscard]] cl::Kernel kernel(const std::string& name) const;

  private:
    /// Waits for the compiler. Begins again after an Error(ErrorKind::out_of_memory), because there may be
    /// memory by now.
    [[nodiscard]] cl::Program built() const;

    Device* device_;
    std::string file_;
    std::string built_file_;  ///< what is compiled: `file_`, or a joint program that includes it
    std::string options_;
    std::shared_future<cl::Program> built_;
};

}  // namespace nearlight::core
