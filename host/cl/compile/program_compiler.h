// SPDX-License-Identifier: Apache-2.0
// Compiles programs in background threads, so that nobody waits for a program before its first launch.
#pragma once

#include <CL/opencl.hpp>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/cl/compile/compile_worker.h"
#include "host/cl/compile/program_build.h"

namespace nearlight::core {

/// Threads that compile programs. Several devices may share one compiler; devices of one kind find each
/// other's programs in the cache.
class ProgramCompiler {
  public:
    /// `workers` compile the programs for CPUs. If there are none, this process does.
    explicit ProgramCompiler(CompileWorkers workers = {}) : workers_(std::move(workers)) {}
    ProgramCompiler(const ProgramCompiler&) = delete;
    ProgramCompiler& operator=(const ProgramCompiler&) = delete;
    /// Stops the workers, waits for programs that this process is compiling, and drops programs that were not
    /// begun.
    ~ProgramCompiler();

    /// Queues a program for build_program(), whose errors the future rethrows. Programs with the longest
    /// source are compiled first, as many at a time as there are workers, but at least two. If the system
    /// gives no thread at all, the caller compiles the program before this returns.
    std::shared_future<cl::Program> start(ProgramRequest request);

    /// Whether a program is being compiled or loaded, or waits for that.
    [[nodiscard]] bool is_busy();

    /// The seconds in which at least one program was being compiled or loaded.
    [[nodiscard]] double busy_seconds();

  private:
    using Job = std::packaged_task<cl::Program(CompileContexts&, CompileWorker*)>;
    struct Waiting {
        std::size_t length;  ///< length of the source
        Job job;
    };
    void work(CompileWorker* worker);
    void run_first(std::unique_lock<std::mutex>& lock, CompileContexts& contexts, CompileWorker* worker);

    CompileWorkers workers_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Waiting> jobs_;  ///< ordered by length, the longest first
    int running_ = 0;
    Stopwatch since_;  ///< runs from the moment when `running_` last left 0
    double busy_seconds_ = 0;
    bool ending_ = false;
    std::vector<std::jthread> threads_;  // declared last: threads use the other members
};

}  // namespace nearlight::core
