// SPDX-License-Identifier: Apache-2.0
#include "host/cl/profiler.h"

namespace nearlight::core {

const std::map<std::string, Profiler::Total>& Profiler::totals() {
    for (auto& [label, event] : pending_) {
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
    pending_.clear();
    return totals_;
}

}  // namespace nearlight::core
