// SPDX-License-Identifier: Apache-2.0
// Calls functions of kernels/lib/ from a kernel in the test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "host/cl/kernel.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core::test {

/// Compiles `source`, which may include the kernel library and has the entry point `probe`. Buffers belong to
/// device(), not to the one that it is like. The library is that of the like device's kernels, or the
/// source's.
class KernelProbe {
  public:
    KernelProbe(const Device& like, const std::string& source)
        : device_(like.entry(), options(like, source)), kernel_(Program(device_, "probe.cl"), "probe") {}

    [[nodiscard]] Device& device() { return device_; }
    [[nodiscard]] Kernel& kernel() { return kernel_; }

  private:
    DeviceOptions options(const Device& like, const std::string& source) {
        const std::filesystem::path given = like.options().kernel_dir;
        const std::filesystem::path kernels =
            given.empty() ? std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "kernels" : given;
        for (const char* folder : {"lib", "shared"}) {
            std::filesystem::copy(kernels / folder, folder_ / folder,
                                  std::filesystem::copy_options::recursive);
        }
        std::ofstream(folder_ / "probe.cl") << source;
        return {.kernel_dir = folder_.path(), .cache_dir = "none"};
    }

    TemporaryFolder folder_;
    Device device_;
    Kernel kernel_;
};

}  // namespace nearlight::core::test
