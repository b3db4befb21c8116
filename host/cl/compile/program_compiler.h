// SPDX-License-Identifier: Apache-2.0
// Threads in which programs are compiled, so that nobody waits for one before its first launch.
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

/// May be shared by several devices; what one has compiled, others of its kind find in the cache.
class ProgramCompiler {
  public:
    /// Programs for CPUs are compiled by `workers`, or in this process where there are none.
    explicit ProgramCompiler(CompileWorkers workers = {}) : workers_(std::move(workers)) {}
    ProgramCompiler(const ProgramCompiler&) = delete;
    ProgramCompiler& operator=(const ProgramCompiler&) = delete;
    /// Stops workers, waits for what is being compiled in this process, and drops what has not begun.
    ~ProgramCompiler();

    /// The program as build_program() makes it, errors included; longest source first, as many at a
    /// time as there are workers, two at least.
    std::shared_future<cl::Program> start(ProgramRequest request);

    /// During which something was being compiled or loaded.
    [[nodiscard]] double busy_seconds();

  private:
    using Job = std::packaged_task<cl::Program(CompileContexts&, CompileWorker*)>;
    struct Waiting {
        std::size_t length;  ///< of the source
        Job job;
    };
    void work(CompileWorker* worker);

    CompileWorkers workers_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Waiting> jobs_;  ///< the longest first
    int running_ = 0;
    Stopwatch since_;  ///< when `running_` was 0 for the last time
    double busy_seconds_ = 0;
    bool ending_ = false;
    std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace nearlight::core
