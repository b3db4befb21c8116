// SPDX-License-Identifier: Apache-2.0
#include "host/cl/profiler.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kMaxPending = 1000;

}  // namespace

void Profiler::record(const std::string& label, cl::Event event) {
    if (pending_.size() >= kMaxPending) {
        add_up(kMaxPending / 2);
    }
    pending_.emplace_back(label, std::move(event));
}

const std::map<std::string, Profiler::Total>& Profiler::totals() {
    add_up(pending_.size());
    return totals_;
}

void Profiler::add_up(std::size_t count) {
    const auto end_of_oldest = pending_.begin() + static_cast<std::ptrdiff_t>(count);
    for (auto launch = pending_.begin(); launch != end_of_oldest; ++launch) {
        const auto& [label, event] = *launch;
        Total& total = totals_[label];
        ++total.launches;
        try {
            event.wait();
            const cl_ulong start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
            const cl_ulong end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            total.seconds += static_cast<double>(end - start) * 1e-9;
        } catch (const cl::Error&) {
            // The driver has no time for this launch. If the launch failed, whoever waited for it has
            // reported that.
        }
    }
    pending_.erase(pending_.begin(), end_of_oldest);
}

}  // namespace nearlight::core
