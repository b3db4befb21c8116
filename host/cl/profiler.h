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

    /// Keeps the event of a launch until its time is added up. There are never more than a thousand, because
    /// drivers hold memory for each; for one more, this waits for the older half.
    void record(const std::string& label, cl::Event event);
    /// Waits for the recorded launches and adds up their times by label. A launch counts as 0 s if the driver
    /// measures no time.
    const std::map<std::string, Total>& totals();

  private:
    /// Adds up the oldest `count` launches.
    void add_up(std::size_t count);

    std::vector<std::pair<std::string, cl::Event>> pending_;
    std::map<std::string, Total> totals_;
};

}  // namespace nearlight::core
