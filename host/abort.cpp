// SPDX-License-Identifier: Apache-2.0
// The program's own abort(), which libraries that it loads call too. OpenCL drivers end the process with it:
// PoCL and LLVM do so where memory, the disk or open files run out, and nobody can catch that. A handler of
// SIGABRT would not do, because LLVM replaces it.
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "host/cl/devices/driver_cache.h"
#include "host/cli/exit_code.h"

namespace {

using nearlight::core::ExitCode;

/// Says why the process ends, and ends it.
[[noreturn]] void end(std::string_view message) {
    static_cast<void>(!write(STDERR_FILENO, message.data(), message.size()));
    rlimit limit{};
    const bool is_limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    _exit(static_cast<int>(is_limited ? ExitCode::out_of_memory : ExitCode::runtime));
}

}  // namespace

extern "C" void abort() noexcept {
    constexpr std::string_view kExhausted =
        "nearlight: error: aborted, as OpenCL drivers do where memory, the disk of their cache or open files "
        "(ulimit -n) run out; free some, or use another device (--device)\n";
    constexpr std::string_view kEmptyKernels =
        "nearlight: error: aborted, because PoCL had left kernels unfinished, for lack of memory, of "
        "processes "
        "or of open files; they are removed now, so run the command again\n";
    // A search that fails in this state of the process may end here again. Other threads that come here wait
    // until the first one ends the process.
    static std::atomic<pid_t> searching = 0;
    pid_t none = 0;
    if (searching.compare_exchange_strong(none, gettid())) {
        end(nearlight::core::remove_empty_kernels() > 0 ? kEmptyKernels : kExhausted);
    }
    if (none == gettid()) {
        end(kExhausted);
    }
    for (;;) {
        pause();
    }
}

/// What assert() calls in glibc, whose own abort() cannot be replaced.
extern "C" [[noreturn]] void __assert_fail(const char* assertion, const char* file, unsigned line,
                                           const char*) noexcept {
    std::fprintf(stderr, "%s:%u: assertion '%s' failed\n", file, line, assertion);
    abort();
}
