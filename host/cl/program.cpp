// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program.h"

#include <utility>

#include "host/cl/kernel_source.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {
namespace {

std::shared_future<cl::Program> begin_build(Device& device, const std::string& file, std::string options) {
    return device.start_build(file, expand_kernel_source(file, device.options().kernel_dir),
                              std::move(options));
}

// The options do not include -cl-fast-relaxed-math and -cl-finite-math-only, because these break slab tests,
// which rely on infinities.
std::string build_options(const Device& device, const Defines& defines) {
    std::string options = "-cl-std=CL1.2 -cl-mad-enable -cl-denorms-are-zero";
    options += device.has_wide_rays() ? " -DNEARLIGHT_WIDE_RAYS=1" : " -DNEARLIGHT_WIDE_RAYS=0";
    options += device.is_cpu() ? " -DNEARLIGHT_CPU=1" : " -DNEARLIGHT_CPU=0";
    for (const auto& [name, value] : defines) {
        options += " -D" + name + "=" + value;
    }
    return options;
}

}  // namespace

Program::Program(Device& device, const std::string& file, const Defines& defines)
    : device_(&device),
      file_(file),
      built_file_(file),
      options_(build_options(device, defines)),
      built_(begin_build(device, built_file_, options_)) {}

Program::Program(Device& device, const std::string& file, const JointProgram& joint)
    : device_(&device),
      file_(file),
      built_file_(device.is_cpu() ? joint.file : file),
      options_(build_options(device, {})),
      built_(begin_build(device, built_file_, options_)) {}

cl::Program Program::built() const {
    try {
        return built_.get();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::out_of_memory) {
            throw;
        }
    }
    return begin_build(*device_, built_file_, options_).get();
}

cl::Kernel Program::kernel(const std::string& name) const {
    return with_opencl_errors("kernel " + name + " of kernels/" + file_ + " on device " + device_->name(),
                              [&] { return cl::Kernel(built(), name.c_str()); });
}

}  // namespace nearlight::core
