// SPDX-License-Identifier: Apache-2.0
// A process of its own that compiles programs for this one.
//
// PoCL generates code for one kernel at a time in a process, however many threads ask. Processes do not wait
// for one another.
#pragma once

#include <sys/types.h>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "host/cl/compile/program_build.h"

namespace nearlight::core {

/// Ends with this object, or with the process that started it, whichever is first. compile() is for one
/// thread at a time, stop() for any.
class CompileWorker {
  public:
    ~CompileWorker();
    CompileWorker(const CompileWorker&) = delete;
    CompileWorker& operator=(const CompileWorker&) = delete;

    /// Asks the worker, and waits. Empty where the program does not compile, has no binary, or the worker is
    /// gone: the caller compiles then, and so finds out why.
    ProgramBinary compile(const ProgramRequest& request);
    /// At once, also while another thread waits in compile(), which then returns.
    void stop();
    [[nodiscard]] bool stopped() const { return stopped_; }
    [[nodiscard]] pid_t process() const { return process_; }

  private:
    friend std::vector<std::unique_ptr<CompileWorker>> start_compile_workers(std::size_t count);
    CompileWorker(pid_t process, int socket) : process_(process), socket_(socket) {}

    pid_t process_;
    int socket_;
    std::atomic<bool> stopped_{false};
};

using CompileWorkers = std::vector<std::unique_ptr<CompileWorker>>;

/// As many as there are processors, 4 at most; none on a single processor, where they would only cost.
std::size_t default_compile_worker_count();

/// Fewer where the system gives no more. Workers are copies of the calling process (fork) and load the driver
/// themselves: must be called from the main thread before there are others, and before list_devices().
/// They take 0.3 ms each while they have nothing to do.
CompileWorkers start_compile_workers(std::size_t count = default_compile_worker_count());

}  // namespace nearlight::core
