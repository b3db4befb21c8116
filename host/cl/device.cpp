// SPDX-License-Identifier: Apache-2.0
#include "host/cl/device.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>

#include "host/base/message.h"
#include "host/cl/compile/program_compiler.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {

namespace {

/// Whether a build is over and made no program. What failed may work when it is tried again.
bool has_failed(const std::shared_future<cl::Program>& build) {
    if (build.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return false;
    }
    try {
        static_cast<void>(build.get());
        return false;
    } catch (const std::exception&) {
        return true;
    }
}

}  // namespace

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

// Copies of handles can fail too, as any call of OpenCL.
Device::Device(const DeviceEntry& entry, const DeviceOptions& options) try
    : entry_(entry), options_(options) {
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
    context_ = cl::Context(entry_.handle);
    queue_ = cl::CommandQueue(context_, entry_.handle, CL_QUEUE_PROFILING_ENABLE);
} catch (const cl::Error& error) {
    throw Error(ErrorKind::no_device,
                "OpenCL device '" + entry.name + "' does not start: " + error.what() + " gave " +
                    opencl_error_name(error.err()) + "; choose another device",
                "device");
}

std::vector<std::unique_ptr<Device>> open_devices(std::span<const DeviceEntry> entries,
                                                  const DeviceOptions& options) {
    DeviceOptions shared = options;
    if (shared.compiler == nullptr) {
        shared.compiler = std::make_shared<ProgramCompiler>();
    }
    std::vector<std::unique_ptr<Device>> devices;
    for (const DeviceEntry& entry : entries) {
        say_debug("device " + std::to_string(entry.index) + ": " + entry.label() + ", " + entry.platform +
                  ", driver " + entry.driver);
        try {
            devices.push_back(std::make_unique<Device>(entry, shared));
        } catch (const Error& error) {
            if (devices.empty() && &entry == &entries.back()) {
                throw;
            }
            say_lost_device(entry.label(), error.what());
        }
    }
    return devices;
}

std::size_t Device::worker_count() const {
    return std::size_t{tunables().runs_per_unit} * std::max(1u, entry_.compute_units);
}

std::shared_future<cl::Program> Device::start_build(const std::string& file, std::string source,
                                                    std::string options) {
    return with_opencl_errors("kernels/" + file + " on device " + name(), [&] {
        ProgramRequest request{
            entry_, context_, file, std::move(source), std::move(options), options_.cache_dir};
        const std::string key = request.key();
        const auto found = programs_.find(key);
        if (found != programs_.end() && !has_failed(found->second)) {
            return found->second;
        }
        return programs_.insert_or_assign(key, options_.compiler->start(std::move(request))).first->second;
    });
}

void Device::finish() {
    with_opencl_errors("device " + name(), [&] { queue_.finish(); });
}

void Device::add_allocated(std::size_t bytes) {
    const std::size_t allocated = allocated_bytes_ += bytes;
    for (std::size_t peak = peak_bytes_; peak < allocated;) {
        if (peak_bytes_.compare_exchange_weak(peak, allocated)) {
            return;
        }
    }
}

}  // namespace nearlight::core
