// SPDX-License-Identifier: Apache-2.0
#include "host/cli/compile_notice.h"

#include <unistd.h>

#include "host/cl/compile/program_compiler.h"
#include "host/cli/log.h"

namespace nearlight::core {

CompileNotice::CompileNotice(const Device& device, std::chrono::milliseconds patience) {
    if (isatty(STDERR_FILENO) != 0) {
        thread_ = std::jthread(
            [this, &device, patience](const std::stop_token& stop) { watch(stop, device, patience); });
    }
}

void CompileNotice::watch(const std::stop_token& stop, const Device& device,
                          std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    const bool has_ended = ended_.wait_for(lock, stop, patience, [&] { return stop.stop_requested(); });
    if (!has_ended && device.compiler().is_busy()) {
        spdlog::info(
            "compiling kernels for {}{}", device.entry().label(),
            device.options().cache_dir == "none" ? "" : "; later runs find them in the cache folder");
    }
}

}  // namespace nearlight::core
