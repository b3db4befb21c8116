// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/cl/kernel_source.h"
#include "host/cl/opencl_error.h"
#include "host/cl/program_cache.h"

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

std::string cache_key(const DeviceEntry& entry, const std::string& source, const std::string& options) {
    return entry.platform + "\n" + entry.name + "\n" + entry.version + "\n" + entry.driver + "\n" + options +
           "\n" + hex_digits(fnv1a(source)) +
           hex_digits(fnv1a(source, fnv1a("second half of a 128-bit key"))) + "\n" +
           std::to_string(source.size());
}

void build(const cl::Program& program, const DeviceEntry& entry, const std::string& options) {
    program.build({entry.handle}, options.c_str());
}

std::optional<cl::Program> load_cached(const Device& device, const ProgramCache& cache,
                                       const std::string& key, const std::string& options) {
    auto binary = cache.find(key);
    if (!binary) {
        return std::nullopt;
    }
    try {
        cl::Program program(device.context(), {device.entry().handle},
                            cl::Program::Binaries{std::move(*binary)});
        build(program, device.entry(), options);
        return program;
    } catch (const cl::Error& error) {
        say_debug("cached program refused by the driver (" + opencl_error_name(error.err()) +
                  "), compiling again");
        return std::nullopt;
    }
}

void store_binary(const cl::Program& program, const ProgramCache& cache, const std::string& key) {
    try {
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        if (!binaries.empty() && !binaries.front().empty()) {
            cache.store(key, binaries.front());
        }
    } catch (const cl::Error& error) {
        say_debug("the driver gives no binary to keep (" + opencl_error_name(error.err()) + ")");
    }
}

std::string first_error_line(const std::string& log) {
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("error") != std::string::npos) {
            return line;
        }
    }
    return log.empty() ? "no build log" : log.substr(0, log.find('\n'));
}

Error make_build_error(const cl::Program& program, const DeviceEntry& entry, const std::string& file,
                       const std::string& source, const std::string& options, cl_int code) {
    std::string log;
    try {
        log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(entry.handle);
    } catch (const cl::Error&) {
        log = "the driver gives no build log";
    }
    std::error_code ignored;
    std::string stem = std::filesystem::path(file).stem().string();
    const std::filesystem::path base =
        std::filesystem::temp_directory_path(ignored) /
        ("nearlight-failed-" + stem + "-" + hex_digits(fnv1a(source)).substr(0, 8));
    std::ofstream(base.string() + ".cl") << source;
    std::ofstream(base.string() + ".log")
        << "device: " << entry.name << "\ndriver: " << entry.driver << "\nversion: " << entry.version
        << "\noptions: " << options << "\n\n"
        << log;
    say_error("build log of kernels/" + file + ":\n" + log);
    return {ExitCode::kernel_build, "kernels/" + file + " does not compile (" + opencl_error_name(code) +
                                        ") on device " + entry.name + ", driver " + entry.driver +
                                        ", options " + options + ": " + first_error_line(log) +
                                        "; expanded source and log are in " + base.string() + ".cl and .log"};
}

}  // namespace

Program::Program(Device& device, const std::string& file, const Defines& defines)
    : device_(&device), file_(file) {
    const std::string source = expand_kernel_source(file, device.options().kernel_dir);
    const std::string options = build_options(device, defines);
    const ProgramCache cache(device.options().cache_dir);
    const std::string key = cache_key(device.entry(), source, options);
    if (auto cached = load_cached(device, cache, key, options)) {
        handle_ = *cached;
        return;
    }
    say_debug("compiling kernels/" + file + " for " + device.name());
    handle_ = with_opencl_errors("kernels/" + file, [&] { return cl::Program(device.context(), source); });
    try {
        build(handle_, device.entry(), options);
    } catch (const cl::Error& error) {
        throw make_build_error(handle_, device.entry(), file, source, options, error.err());
    }
    store_binary(handle_, cache, key);
}

cl::Kernel Program::kernel(const std::string& name) const {
    return with_opencl_errors("kernel " + name + " of kernels/" + file_,
                              [&] { return cl::Kernel(handle_, name.c_str()); });
}

}  // namespace nearlight
