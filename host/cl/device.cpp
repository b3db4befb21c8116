// SPDX-License-Identifier: Apache-2.0
#include "host/cl/device.h"

#include <algorithm>
#include <cstdlib>

#include "host/base/message.h"
#include "host/cl/compile/program_compiler.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {

std::filesystem::path default_cache_dir() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value == nullptr ? "" : value);
    };
    if (const auto dir = variable("NEARLIGHT_CACHE_DIR"); !dir.empty()) {
        return dir;
    }
    if (const auto dir = variable("XDG_CACHE_HOME"); !dir.empty()) {
        return dir / "nearlight";
    }
    const auto home = variable("HOME");
    return home.empty() ? home : home / ".cache" / "nearlight";
}

Device::Device(const DeviceEntry& entry, const DeviceOptions& options) : entry_(entry), options_(options) {
    if (options_.cache_dir.empty()) {
        options_.cache_dir = default_cache_dir();
    }
    tunables_ = choose_tunables(entry_, options_.cache_dir, options_.kernel_dir);
    if (!tunables_.warning.empty()) {
        say_warning(tunables_.warning);
    }
    if (options_.compiler == nullptr) {
        options_.compiler = std::make_shared<ProgramCompiler>();
    }
    try {
        context_ = cl::Context(entry_.handle);
        queue_ = cl::CommandQueue(context_, entry_.handle, CL_QUEUE_PROFILING_ENABLE);
    } catch (const cl::Error& error) {
        throw Error(ErrorKind::no_device,
                    "OpenCL device '" + entry_.name + "' does not start: " + error.what() + " gave " +
                        opencl_error_name(error.err()) + "; choose another device",
                    "device");
    }
}

std::size_t Device::worker_count() const {
    return std::size_t{tunables().runs_per_unit} * std::max(1u, entry_.compute_units);
}

std::shared_future<cl::Program> Device::start_build(const std::string& file, std::string source,
                                                    std::string options) {
    ProgramRequest request{entry_, context_, file, std::move(source), std::move(options), options_.cache_dir};
    const auto [found, is_new] = programs_.try_emplace(request.key());
    if (is_new) {
        found->second = options_.compiler->start(std::move(request));
    }
    return found->second;
}

void Device::finish() {
    with_opencl_errors("device " + name(), [&] { queue_.finish(); });
}

void Device::add_allocated(std::size_t bytes) {
    allocated_bytes_ += bytes;
    peak_bytes_ = std::max(peak_bytes_, allocated_bytes_);
}

}  // namespace nearlight::core
