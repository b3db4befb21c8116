// SPDX-License-Identifier: Apache-2.0
// Worker processes that compile programs for this one.
//
// In one process, PoCL generates code for one kernel at a time, however many threads ask. Processes do not
// wait for one another.
#pragma once

#include <sys/types.h>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "host/cl/compile/program_build.h"

namespace nearlight::core {

/// A process that compiles programs. It ends with this object or with the process that started it, whichever
/// ends first. compile() may be called by one thread at a time, stop() by any thread.
class CompileWorker {
  public:
    ~CompileWorker();
    CompileWorker(const CompileWorker&) = delete;
    CompileWorker& operator=(const CompileWorker&) = delete;

    /// Has the worker compile a program, and waits for its binary. The binary is empty if the program does
    /// not compile or has no binary, or if the worker is gone. The caller then compiles the program itself
    /// and so learns the reason.
    ProgramBinary compile(const ProgramRequest& request);
    /// Ends the process at once. If another thread waits in compile(), that call returns.
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

/// The number of processors, but at most 4, and 0 on a single processor, where workers would only cost time.
std::size_t default_compile_worker_count();

/// Starts `count` workers, or fewer if the system allows no more. Workers are copies of the calling process
/// (fork) and load the driver themselves, so this must be called from the main thread before there are other
/// threads, and before list_devices(). A worker that never compiles costs 0.3 ms.
CompileWorkers start_compile_workers(std::size_t count = default_compile_worker_count());

}  // namespace nearlight::core
