// SPDX-License-Identifier: Apache-2.0
// Device time by kernel, from OpenCL's own event clocks.
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <string>
#include <vector>

namespace nearlight::core {

class Profiler {
  public:
    struct Total {
        double seconds = 0;
        int launches = 0;
    };

    void record(const std::string& label, cl::Event event) { pending_.emplace_back(label, std::move(event)); }
    /// Waits for the recorded launches and adds up their times by label. A launch counts as 0 s if the driver
    /// measures no time.
    const std::map<std::string, Total>& totals();

  private:
    std::vector<std::pair<std::string, cl::Event>> pending_;
    std::map<std::string, Total> totals_;
};

}  // namespace nearlight::core
