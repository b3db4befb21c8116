// SPDX-License-Identifier: Apache-2.0
// One program, from the cache or from its source.
#pragma once

#include <CL/opencl.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/cl/devices/device_list.h"

namespace nearlight::core {

/// What to compile, for which device, and where to keep the result.
struct ProgramRequest {
    DeviceEntry entry;
    cl::Context context;  ///< the context that uses the program
    std::string file;     ///< name of kernels/`file`, for messages
    std::string source;   ///< text with its includes expanded
    std::string options;
    std::filesystem::path cache_dir;

    /// The key in caches, which is equal for equal programs on equal devices, in every process.
    [[nodiscard]] std::string key() const;
};

/// The contexts that one compiling thread uses, by device. They are made when they are first needed.
using CompileContexts = std::map<cl_device_id, cl::Context>;

/// The context of a device, which is new if `contexts` have none of it yet. Throws cl::Error, and leaves them
/// as they were.
cl::Context context_of(const cl::Device& device, CompileContexts& contexts);

using ProgramBinary = std::vector<unsigned char>;

class CompileWorker;

/// Makes the program in request.context, from the cache or by compiling it. Programs for CPUs are compiled
/// elsewhere and taken over as binaries, because PoCL compiles one program at a time in each context:
/// `worker` compiles them, or, if it is null or fails, a context of `contexts`. Throws
/// Error(ErrorKind::kernel_build) with the build log's first error, after saving the expanded source and the
/// whole log to files that the message names.
cl::Program build_program(const ProgramRequest& request, CompileContexts& contexts, CompileWorker* worker);

}  // namespace nearlight::core
