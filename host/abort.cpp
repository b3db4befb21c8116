// SPDX-License-Identifier: Apache-2.0
// The program's own abort(), which libraries that it loads call too. OpenCL drivers end the process with it:
// PoCL and LLVM do so where memory or the disk runs out, and nobody can catch that. A handler of SIGABRT
// would not do, because LLVM replaces it.
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "host/cli/exit_code.h"

extern "C" void abort() noexcept {
    using nearlight::core::ExitCode;
    constexpr std::string_view kMessage =
        "nearlight: error: aborted, as OpenCL drivers do where memory, or the disk of their cache, is full; "
        "free some, or use another device (--device)\n";
    static_cast<void>(!write(STDERR_FILENO, kMessage.data(), kMessage.size()));
    rlimit limit{};
    const bool is_limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    _exit(static_cast<int>(is_limited ? ExitCode::out_of_memory : ExitCode::runtime));
}

/// What assert() calls in glibc, whose own abort() cannot be replaced.
extern "C" [[noreturn]] void __assert_fail(const char* assertion, const char* file, unsigned line,
                                           const char*) noexcept {
    std::fprintf(stderr, "%s:%u: assertion '%s' failed\n", file, line, assertion);
    abort();
}
