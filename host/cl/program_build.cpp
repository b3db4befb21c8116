// SPDX-License-Identifier: Apache-2.0
#include "host/cl/program_build.h"

#include <fstream>
#include <optional>
#include <sstream>

#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/base/stopwatch.h"
#include "host/cl/opencl_error.h"
#include "host/cl/program_cache.h"

namespace nearlight {
namespace {

using Binary = std::vector<unsigned char>;

void build(const cl::Program& program, const DeviceEntry& entry, const std::string& options) {
    program.build({entry.handle}, options.c_str());
}

/// Empty where the driver refuses the binary.
std::optional<cl::Program> from_binary(const ProgramRequest& request, Binary binary) {
    try {
        cl::Program program(request.context, {request.entry.handle},
                            cl::Program::Binaries{std::move(binary)});
        build(program, request.entry, request.options);
        return program;
    } catch (const cl::Error& error) {
        say_debug("binary of kernels/" + request.file + " refused by the driver (" +
                  opencl_error_name(error.err()) + "), compiling again");
        return std::nullopt;
    }
}

/// Empty where the driver gives none.
Binary binary_of(const cl::Program& program) {
    try {
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        return binaries.empty() ? Binary() : binaries.front();
    } catch (const cl::Error& error) {
        say_debug("the driver gives no binary to keep (" + opencl_error_name(error.err()) + ")");
        return {};
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

Error make_build_error(const cl::Program& program, const ProgramRequest& request, cl_int code) {
    const DeviceEntry& entry = request.entry;
    std::string log;
    try {
        log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(entry.handle);
    } catch (const cl::Error&) {
        log = "the driver gives no build log";
    }
    std::error_code ignored;
    const std::string stem = std::filesystem::path(request.file).stem().string();
    const std::filesystem::path base =
        std::filesystem::temp_directory_path(ignored) /
        ("nearlight-failed-" + stem + "-" + hex_digits(fnv1a(request.source)).substr(0, 8));
    std::ofstream(base.string() + ".cl") << request.source;
    std::ofstream(base.string() + ".log")
        << "device: " << entry.name << "\ndriver: " << entry.driver << "\nversion: " << entry.version
        << "\noptions: " << request.options << "\n\n"
        << log;
    say_error("build log of kernels/" + request.file + ":\n" + log);
    return {ExitCode::kernel_build,
            "kernels/" + request.file + " does not compile (" + opencl_error_name(code) + ") on device " +
                entry.name + ", driver " + entry.driver + ", options " + request.options + ": " +
                first_error_line(log) + "; expanded source and log are in " + base.string() + ".cl and .log"};
}

cl::Program from_source(const ProgramRequest& request, const cl::Context& context) {
    const cl::Program program =
        with_opencl_errors("kernels/" + request.file, [&] { return cl::Program(context, request.source); });
    try {
        build(program, request.entry, request.options);
    } catch (const cl::Error& error) {
        throw make_build_error(program, request, error.err());
    }
    return program;
}

cl::Context compile_context(const ProgramRequest& request, CompileContexts& contexts) {
    if (request.entry.kind != DeviceKind::cpu) {
        return request.context;
    }
    const auto [found, is_new] = contexts.try_emplace(request.entry.handle());
    if (is_new) {
        found->second =
            with_opencl_errors("kernels/" + request.file, [&] { return cl::Context(request.entry.handle); });
    }
    return found->second;
}

}  // namespace

std::string ProgramRequest::key() const {
    return entry.platform + "\n" + entry.name + "\n" + entry.version + "\n" + entry.driver + "\n" + options +
           "\n" + hex_digits(fnv1a(source)) +
           hex_digits(fnv1a(source, fnv1a("second half of a 128-bit key"))) + "\n" +
           std::to_string(source.size());
}

cl::Program build_program(const ProgramRequest& request, CompileContexts& contexts) {
    const ProgramCache cache(request.cache_dir);
    const std::string key = request.key();
    if (auto kept = cache.find(key)) {
        if (auto program = from_binary(request, std::move(*kept))) {
            return *program;
        }
    }
    const Stopwatch watch;
    const cl::Context context = compile_context(request, contexts);
    cl::Program program = from_source(request, context);
    const Binary binary = binary_of(program);
    if (!binary.empty()) {
        cache.store(key, binary);
    }
    say_debug("compiled kernels/" + request.file + " for " + request.entry.name + " in " +
              std::to_string(watch.seconds()) + " s");
    if (context() == request.context()) {
        return program;
    }
    const auto taken_over = binary.empty() ? std::nullopt : from_binary(request, binary);
    return taken_over ? *taken_over : from_source(request, request.context);
}

}  // namespace nearlight
