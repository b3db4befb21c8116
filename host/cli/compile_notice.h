// SPDX-License-Identifier: Apache-2.0
// Says why nothing is to be seen yet when a device meets the kernels for the first time.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "host/cl/device.h"

namespace nearlight::core {

/// Says once, on standard error if that is a terminal, that kernels are being compiled, if they still are
/// after `patience`. Compilation takes ten seconds on two processor cores, and up to half a minute for a GPU.
class CompileNotice {
  public:
    /// `device` must outlive the notice.
    explicit CompileNotice(const Device& device,
                           std::chrono::milliseconds patience = std::chrono::seconds(2));
    /// Returns at once; nothing is said from then on.
    ~CompileNotice() = default;
    CompileNotice(const CompileNotice&) = delete;
    CompileNotice& operator=(const CompileNotice&) = delete;

  private:
    void watch(const std::stop_token& stop, const Device& device, std::chrono::milliseconds patience);

    std::mutex mutex_;
    std::condition_variable_any ended_;
    std::jthread thread_;  // declared last: it uses the other members
};

}  // namespace nearlight::core
