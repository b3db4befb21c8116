// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program.h"

#include "host/cl/kernel_source.h"
#include "host/cl/opencl_error.h"

namespace nearlight {
namespace {

// -cl-fast-relaxed-math and -cl-finite-math-only are left out on purpose: they break slab tests, which rely
// on infinities.
std::string build_options(const Device& device, const Defines& defines) {
    std::string options = "-cl-std=CL1.2 -cl-mad-enable -cl-denorms-are-zero";
    options += device.is_cpu() ? " -DNEARLIGHT_DEVICE_CPU=1" : " -DNEARLIGHT_DEVICE_CPU=0";
    for (const auto& [name, value] : defines) {
        options += " -D" + name + "=" + value;
    }
    return options;
}

}  // namespace

Program::Program(Device& device, const std::string& file, const Defines& defines)
    : device_(&device),
      file_(file),
      built_(device.start_build(file, expand_kernel_source(file, device.options().kernel_dir),
                                build_options(device, defines))) {}

cl::Kernel Program::kernel(const std::string& name) const {
    const cl::Program& program = built_.get();
    return with_opencl_errors("kernel " + name + " of kernels/" + file_,
                              [&] { return cl::Kernel(program, name.c_str()); });
}

}  // namespace nearlight
