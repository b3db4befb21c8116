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

/// What is to be compiled, for which device, and where the outcome is kept.
struct ProgramRequest {
    DeviceEntry entry;
    cl::Context context;  ///< in which the program is to be used
    std::string file;     ///< for messages: kernels/`file`
    std::string source;   ///< includes expanded
    std::string options;
    std::filesystem::path cache_dir;

    /// Equal for equal programs on equal devices, over processes.
    [[nodiscard]] std::string key() const;
};

/// Contexts of one thread that compiles, made when first needed.
using CompileContexts = std::map<cl_device_id, cl::Context>;

using ProgramBinary = std::vector<unsigned char>;

class CompileWorker;

/// The program in request.context, from the cache or compiled. What is compiled for a CPU is taken over as a
/// binary: from `worker`, where there is one that compiles it, or else from a context of `contexts`, for PoCL
/// compiles one program at a time in each. Throws Error(ErrorKind::kernel_build) with the build log's first
/// error, after saving the expanded source and the whole log to files that the message names.
cl::Program build_program(const ProgramRequest& request, CompileContexts& contexts, CompileWorker* worker);

}  // namespace nearlight::core
