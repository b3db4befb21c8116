// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "host/cl/kernel_source.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {
namespace {

/// Files of kernels/joint/ and what they include. PoCL spends 0.1 s on each program before its first line,
/// and works on functions that stages share once for each program.
struct JointProgram {
    const char* file;
    std::vector<std::string> stages;
};
const std::array<JointProgram, 3> kJointPrograms{
    {{"joint/view.cl", {"camera_pass.cl", "direct_light.cl", "film.cl"}},
     {"joint/walks.cl", {"bounce_tracer.cl", "light_tracer.cl"}},
     {"joint/vpls.cl",
      {"compaction.cl", "morton_sort.cl", "patch_vpls.cl", "triangle_classifier.cl", "vpl_contribution.cl",
       "vpl_light.cl", "vpl_placement.cl"}}}};

/// The file to compile for the kernels of `stage`. Elsewhere than on CPUs a stage that a driver does not
/// compile shall not take others with it.
std::string file_to_compile(const Device& device, const std::string& stage, const Defines& defines) {
    for (const JointProgram& joint : kJointPrograms) {
        if (device.is_cpu() && defines.empty() && std::ranges::count(joint.stages, stage) > 0) {
            return joint.file;
        }
    }
    return stage;
}

std::shared_future<cl::Program> begin_build(Device& device, const std::string& file, std::string options) {
    return device.start_build(file, expand_kernel_source(file, device.options().kernel_dir),
                              std::move(options));
}

// -cl-fast-relaxed-math and -cl-finite-math-only are left out on purpose: they break slab tests, which rely
// on infinities.
std::string build_options(const Device& device, const Defines& defines) {
    std::string options = "-cl-std=CL1.2 -cl-mad-enable -cl-denorms-are-zero";
    options += device.has_wide_rays() ? " -DNEARLIGHT_WIDE_RAYS=1" : " -DNEARLIGHT_WIDE_RAYS=0";
    for (const auto& [name, value] : defines) {
        options += " -D" + name + "=" + value;
    }
    return options;
}

}  // namespace

Program::Program(Device& device, const std::string& file, const Defines& defines)
    : device_(&device),
      file_(file),
      built_(begin_build(device, file_to_compile(device, file, defines), build_options(device, defines))) {}

cl::Kernel Program::kernel(const std::string& name) const {
    const cl::Program& program = built_.get();
    return with_opencl_errors("kernel " + name + " of kernels/" + file_,
                              [&] { return cl::Kernel(program, name.c_str()); });
}

}  // namespace nearlight::core
