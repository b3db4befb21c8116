// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_build.h"

#include <cstdlib>
#include <optional>
#include <sstream>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/memory.h"
#include "host/base/message.h"
#include "host/base/stopwatch.h"
#include "host/cl/compile/build_lock.h"
#include "host/cl/compile/compile_worker.h"
#include "host/cl/compile/program_cache.h"
#include "host/cl/devices/driver_cache.h"
#include "host/cl/opencl_error.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// The program, for messages about errors of OpenCL.
std::string subject_of(const ProgramRequest& request) {
    return "kernels/" + request.file + " on device " + request.entry.name;
}

/// Calls the driver's compiler. An exception that passes through it and is no error of OpenCL, such as
/// std::bad_alloc, has left locks behind for which other threads would wait forever. It therefore ends the
/// process, as compilers themselves do where memory runs out.
template <typename Action>
auto in_compiler(const Action& action) {
    try {
        return action();
    } catch (const cl::Error&) {
        throw;
    } catch (...) {
        std::abort();
    }
}

void build(const cl::Program& program, const DeviceEntry& entry, const std::string& options) {
    in_compiler([&] { program.build({entry.handle}, options.c_str()); });
}

/// What the driver is given room for when it takes a binary, and when it compiles a source. PoCL needs about
/// half of that.
constexpr std::size_t kBinaryBytes = std::size_t{96} << 20;
constexpr std::size_t kSourceBytes = std::size_t{256} << 20;

/// Throws Error(ErrorKind::out_of_memory) if a limit leaves too little address space. A driver that runs out
/// of it in the middle of a build ends the process, or keeps a lock for which others then wait forever.
void require_address_space(const ProgramRequest& request, std::size_t bytes) {
    if (const std::size_t left = free_address_space(); left < bytes) {
        throw Error(ErrorKind::out_of_memory,
                    subject_of(request) + " needs " + std::to_string(bytes >> 20) +
                        " MiB of address space to be built, and the limit (ulimit -v) leaves " +
                        std::to_string(left >> 20) + " MiB; raise the limit");
    }
}

/// Makes a program of a binary. Returns nothing if the driver refuses the binary.
std::optional<cl::Program> from_binary(const ProgramRequest& request, ProgramBinary binary) {
    require_address_space(request, kBinaryBytes);
    try {
        const cl::Program::Binaries binaries{std::move(binary)};
        const cl::Program program =
            in_compiler([&] { return cl::Program(request.context, {request.entry.handle}, binaries); });
        build(program, request.entry, request.options);
        return program;
    } catch (const cl::Error& error) {
        say_debug("the driver refuses the binary of kernels/" + request.file + " (" +
                  opencl_error_name(error.err()) + "); compiling again");
        return std::nullopt;
    }
}

/// The binary of a program; empty if the driver gives none.
ProgramBinary binary_of(const cl::Program& program) {
    try {
        const auto binaries = in_compiler([&] { return program.getInfo<CL_PROGRAM_BINARIES>(); });
        return binaries.empty() ? ProgramBinary() : binaries.front();
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

/// Keeps the source and the log of a program that does not compile, and says where, as a part of a sentence.
/// The folder may be one that all users share, so what lies there under the same names is replaced rather
/// than opened: it may be a link to anywhere.
std::string keep_failed_program(const ProgramRequest& request, const std::string& log) {
    const DeviceEntry& entry = request.entry;
    std::error_code ignored;
    const std::string stem = std::filesystem::path(request.file).stem().string();
    const std::filesystem::path base =
        std::filesystem::temp_directory_path(ignored) /
        ("nearlight-failed-" + stem + "-" + hex_digits(hash64(request.source)).substr(0, 8));
    try {
        write_text(base.string() + ".cl", request.source);
        write_text(base.string() + ".log", "device: " + entry.name + "\ndriver: " + entry.driver +
                                               "\nversion: " + entry.version +
                                               "\noptions: " + request.options + "\n\n" + log);
    } catch (const Error& error) {
        return std::string("expanded source and log are lost: ") + error.what();
    }
    return "expanded source and log are in " + base.string() + ".cl and .log";
}

Error make_build_error(const cl::Program& program, const ProgramRequest& request, cl_int code) {
    const DeviceEntry& entry = request.entry;
    std::string log;
    try {
        log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(entry.handle);
    } catch (const cl::Error&) {
        log = "the driver gives no build log";
    }
    say_error("build log of kernels/" + request.file + ":\n" + log);
    return {ErrorKind::kernel_build, "kernels/" + request.file + " does not compile (" +
                                         opencl_error_name(code) + ") on device " + entry.name + ", driver " +
                                         entry.driver + ", options " + request.options + ": " +
                                         first_error_line(log) + "; " + keep_failed_program(request, log)};
}

/// Whether a build that failed with `code` tells something of the source; otherwise the device or its driver
/// failed.
bool is_about_the_source(cl_int code) {
    return code == CL_BUILD_PROGRAM_FAILURE || code == CL_COMPILE_PROGRAM_FAILURE ||
           code == CL_LINK_PROGRAM_FAILURE || code == CL_INVALID_BUILD_OPTIONS;
}

cl::Program from_source(const ProgramRequest& request, const cl::Context& context) {
    const cl::Program program(context, request.source);
    try {
        build(program, request.entry, request.options);
    } catch (const cl::Error& error) {
        if (!is_about_the_source(error.err())) {
            throw;
        }
        throw make_build_error(program, request, error.err());
    }
    return program;
}

cl::Context compile_context(const ProgramRequest& request, CompileContexts& contexts) {
    return request.entry.kind == DeviceKind::cpu ? context_of(request.entry.handle, contexts)
                                                 : request.context;
}

/// A compiled program in request.context, and its binary.
struct Compiled {
    cl::Program program;
    ProgramBinary binary;  ///< empty if the driver gives none
};

Compiled compile_here(const ProgramRequest& request, CompileContexts& contexts) {
    require_address_space(request, kSourceBytes);
    const cl::Context context = compile_context(request, contexts);
    Compiled compiled{from_source(request, context), {}};
    compiled.binary = binary_of(compiled.program);
    if (context() != request.context()) {
        const auto taken_over =
            compiled.binary.empty() ? std::nullopt : from_binary(request, compiled.binary);
        compiled.program = taken_over ? *taken_over : from_source(request, request.context);
    }
    return compiled;
}

/// Compiles a program in a worker. Returns nothing if the program is not for a CPU or the worker makes no
/// binary of it.
std::optional<Compiled> compile_in(CompileWorker* worker, const ProgramRequest& request) {
    if (worker == nullptr || request.entry.kind != DeviceKind::cpu) {
        return std::nullopt;
    }
    ProgramBinary binary = worker->compile(request);
    if (worker->stopped()) {
        throw Error(ErrorKind::failure, "kernels/" + request.file + " is no longer needed");
    }
    if (auto program = binary.empty() ? std::nullopt : from_binary(request, binary)) {
        return Compiled{*program, std::move(binary)};
    }
    say_debug("process " + std::to_string(worker->process()) + " made no binary of kernels/" + request.file +
              "; compiling it in this process");
    return std::nullopt;
}

/// The folder that processes which build the same program share; empty if they need not wait for one another.
std::filesystem::path shared_folder(const ProgramRequest& request) {
    return request.entry.kind == DeviceKind::cpu ? driver_cache() : "";
}

/// Throws Error if the driver has left kernels empty. Their program must not be kept, because a binary of it
/// has them too.
void require_whole_kernels(const ProgramRequest& request, const ProgramBinary& binary) {
    // Another process may have removed the empty files already.
    if (request.entry.kind == DeviceKind::cpu && (remove_empty_kernels() > 0 || lacks_a_kernel(binary))) {
        throw Error(ErrorKind::failure,
                    "kernels/" + request.file + " was not finished by driver " + request.entry.driver +
                        ", for lack of memory, of processes (ulimit -u) or of open files (ulimit -n); free "
                        "some and run the command again");
    }
}

/// Makes the program as build_program() does. Throws cl::Error too.
cl::Program find_or_compile(const ProgramRequest& request, CompileContexts& contexts, CompileWorker* worker) {
    const ProgramCache cache(request.cache_dir);
    const std::string key = request.key();
    const BuildLock lock(shared_folder(request), key, [&] { return worker != nullptr && worker->stopped(); });
    if (auto kept = cache.find(key)) {
        if (auto program = from_binary(request, std::move(*kept))) {
            return *program;
        }
    }
    const Stopwatch watch;
    auto compiled = compile_in(worker, request);
    if (!compiled) {
        compiled = compile_here(request, contexts);
    }
    require_whole_kernels(request, compiled->binary);
    if (!compiled->binary.empty()) {
        cache.store(key, compiled->binary);
    }
    say_debug("compiled kernels/" + request.file + " for " + request.entry.name + " in " +
              std::to_string(watch.seconds()) + " s");
    return compiled->program;
}

}  // namespace

std::string ProgramRequest::key() const {
    return entry.platform + "\n" + entry.name + "\n" + entry.version + "\n" + entry.driver + "\n" + options +
           "\n" + hex_digits(hash128(source)) + "\n" + std::to_string(source.size());
}

cl::Context context_of(const cl::Device& device, CompileContexts& contexts) {
    const auto found = contexts.find(device());
    return found != contexts.end() ? found->second
                                   : contexts.emplace(device(), cl::Context(device)).first->second;
}

cl::Program build_program(const ProgramRequest& request, CompileContexts& contexts, CompileWorker* worker) {
    return with_opencl_errors(subject_of(request),
                              [&] { return find_or_compile(request, contexts, worker); });
}

}  // namespace nearlight::core
