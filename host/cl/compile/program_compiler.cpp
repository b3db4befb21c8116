// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_compiler.h"

#include <algorithm>
#include <system_error>

namespace nearlight::core {
namespace {

/// The minimum number of threads, which matters if there are no workers: PoCL parses in all contexts at the
/// same time, but generates code for one kernel at a time in the whole process.
constexpr std::size_t kMinThreads = 2;

}  // namespace

ProgramCompiler::~ProgramCompiler() {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    jobs_.clear();
    for (const auto& worker : workers_) {
        worker->stop();
    }
    changed_.notify_all();
}

std::shared_future<cl::Program> ProgramCompiler::start(ProgramRequest request) {
    const std::size_t length = request.source.size();
    Job job([request = std::move(request)](CompileContexts& contexts, CompileWorker* worker) {
        return build_program(request, contexts, worker);
    });
    std::shared_future<cl::Program> result = job.get_future();
    std::unique_lock lock(mutex_);
    // The longest source comes first, so that the last programs are short and no worker is left alone with
    // much work.
    const auto place =
        std::ranges::find_if(jobs_, [&](const Waiting& other) { return other.length < length; });
    jobs_.insert(place, {length, std::move(job)});
    if (const std::size_t index = threads_.size(); index < std::max(kMinThreads, workers_.size())) {
        CompileWorker* const worker = index < workers_.size() ? workers_[index].get() : nullptr;
        try {
            threads_.emplace_back([this, worker] { work(worker); });
        } catch (const std::system_error&) {
            // The system gives no more threads; those that there are take the program.
        }
    }
    if (threads_.empty()) {
        CompileContexts contexts;
        run_first(lock, contexts, nullptr);
    } else {
        changed_.notify_one();
    }
    return result;
}

bool ProgramCompiler::is_busy() {
    const std::lock_guard lock(mutex_);
    return running_ > 0 || !jobs_.empty();
}

double ProgramCompiler::busy_seconds() {
    const std::lock_guard lock(mutex_);
    return busy_seconds_ + (running_ > 0 ? since_.seconds() : 0.0);
}

void ProgramCompiler::work(CompileWorker* worker) {
    CompileContexts contexts;
    std::unique_lock lock(mutex_);
    for (;;) {
        if (jobs_.empty() && !contexts.empty()) {
            contexts.clear();  // contexts keep the driver's libraries loaded
        }
        changed_.wait(lock, [&] { return ending_ || !jobs_.empty(); });
        if (ending_) {
            return;
        }
        run_first(lock, contexts, worker);
    }
}

/// Runs the first job, for which it gives the lock up for a while.
void ProgramCompiler::run_first(std::unique_lock<std::mutex>& lock, CompileContexts& contexts,
                                CompileWorker* worker) {
    Job job = std::move(jobs_.front().job);
    jobs_.pop_front();
    if (running_++ == 0) {
        since_.lap();
    }
    lock.unlock();
    job(contexts, worker);
    job = {};
    lock.lock();
    if (--running_ == 0) {
        busy_seconds_ += since_.lap();
    }
}

}  // namespace nearlight::core
