// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/compile_worker.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "host/base/message.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kMaxWorkers = 4;
/// A worker that is idle for this long releases its contexts, which keep the driver's libraries loaded.
constexpr int kIdleMilliseconds = 500;

/// The flags give a process that has lost its partner an error instead of a signal.
#ifdef MSG_NOSIGNAL
constexpr int kSendFlags = MSG_NOSIGNAL;
#else
constexpr int kSendFlags = 0;
#endif

bool send_all(int socket, const void* data, std::size_t size) {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t sent = ::send(socket, bytes, size, kSendFlags);
        if (sent < 0 && errno == EINTR) {
            continue;
        }
        if (sent <= 0) {
            return false;
        }
        bytes += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
    char* bytes = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t received = ::recv(socket, bytes, size, 0);
        if (received < 0 && errno == EINTR) {
            continue;
        }
        if (received <= 0) {
            return false;
        }
        bytes += received;
        size -= static_cast<std::size_t>(received);
    }
    return true;
}

/// Sends the size of a block and then its bytes. The layout is not portable, as both ends are the same
/// program on one machine.
template <typename Bytes>
bool send_block(int socket, const Bytes& block) {
    const std::uint64_t size = block.size();
    return send_all(socket, &size, sizeof size) && send_all(socket, block.data(), block.size());
}

template <typename Bytes>
bool receive_block(int socket, Bytes& block) {
    std::uint64_t size = 0;
    if (!receive_all(socket, &size, sizeof size)) {
        return false;
    }
    block.resize(size);
    return receive_all(socket, block.data(), size);
}

/// The parts of a request that are sent, in this order.
template <typename Request>
auto sent_parts(Request& request) {
    auto& entry = request.entry;
    return std::array{&entry.platform, &entry.name,      &entry.version,
                      &entry.driver,   &request.options, &request.source};
}

/// Finds the worker's own handle of the device that a request is for: one with the same programs (see
/// ProgramRequest::key()).
std::optional<cl::Device> find_device(const DeviceList& list, const DeviceEntry& like) {
    for (const DeviceEntry& entry : list.devices) {
        if (entry.platform == like.platform && entry.name == like.name && entry.version == like.version &&
            entry.driver == like.driver) {
            return entry.handle;
        }
    }
    return std::nullopt;
}

ProgramBinary compile_here(const DeviceList& list, const ProgramRequest& request, CompileContexts& contexts) {
    try {
        const auto device = find_device(list, request.entry);
        if (!device) {
            return {};
        }
        const cl::Program program(context_of(*device, contexts), request.source);
        program.build({*device}, request.options.c_str());
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        return binaries.empty() ? ProgramBinary() : binaries.front();
    } catch (const cl::Error&) {
        return {};
    }
}

/// Answers requests until the other end of the socket is closed.
void serve(int socket) {
    std::optional<DeviceList> devices;
    CompileContexts contexts;
    for (;;) {
        pollfd waiting{socket, POLLIN, 0};
        if (::poll(&waiting, 1, contexts.empty() ? -1 : kIdleMilliseconds) == 0) {
            contexts.clear();
            continue;
        }
        ProgramRequest request;
        for (std::string* part : sent_parts(request)) {
            if (!receive_block(socket, *part)) {
                return;
            }
        }
        if (!devices) {
            devices = list_devices();
        }
        if (!send_block(socket, compile_here(*devices, request, contexts))) {
            return;
        }
    }
}

/// Redirects the worker's standard streams to /dev/null. The parent's compiler prints the same messages, and
/// a reader of the parent's output would otherwise wait for the worker's end.
void leave_terminal() {
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (int stream = STDIN_FILENO; nowhere >= 0 && stream <= STDERR_FILENO; ++stream) {
        dup2(nowhere, stream);
    }
}

/// Serves requests and never returns, because the worker must not go on with the work of the calling process.
[[noreturn]] void run_worker(int socket, pid_t parent) {
    // Ctrl-C in a terminal, or closing it, signals all of its processes, but the parent decides when it needs
    // no more kernels.
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    std::signal(SIGHUP, SIG_IGN);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // on other systems a worker ends after its present program
#endif
    leave_terminal();
    if (getppid() == parent) {
        try {
            serve(socket);
        } catch (...) {
            _exit(1);
        }
    }
    _exit(0);
}

}  // namespace

std::size_t default_compile_worker_count() {
    const std::size_t processors = std::thread::hardware_concurrency();
    return processors < 2 ? 0 : std::min(processors, kMaxWorkers);
}

CompileWorkers start_compile_workers(std::size_t count) {
    CompileWorkers workers;
    const pid_t parent = getpid();
    while (workers.size() < count) {
        int ends[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
            break;
        }
        const pid_t process = fork();
        if (process == 0) {
            close(ends[0]);
            for (const auto& earlier : workers) {
                close(earlier->socket_);  // else earlier workers would not notice the parent's end
            }
            run_worker(ends[1], parent);
        }
        close(ends[1]);
        if (process < 0) {
            close(ends[0]);
            break;
        }
        workers.emplace_back(new CompileWorker(process, ends[0]));
    }
    if (workers.size() < count) {
        say_debug("only " + std::to_string(workers.size()) + " processes could be started to compile in");
    }
    return workers;
}

CompileWorker::~CompileWorker() {
    stop();
    close(socket_);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {}
}

ProgramBinary CompileWorker::compile(const ProgramRequest& request) {
    ProgramBinary binary;
    const bool sent = !stopped_ && std::ranges::all_of(sent_parts(request), [&](const std::string* part) {
        return send_block(socket_, *part);
    });
    if (!sent || !receive_block(socket_, binary)) {
        binary.clear();
    }
    return binary;
}

void CompileWorker::stop() {
    if (!stopped_.exchange(true)) {
        kill(process_, SIGKILL);
    }
}

}  // namespace nearlight::core
