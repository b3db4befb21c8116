// SPDX-License-Identifier: Apache-2.0
#include "host/cli/device_options.h"

#include "host/base/log.h"

namespace nearlight {

void add_device_options(CLI::App& command, DeviceChoice& choice) {
    command
        .add_option("--device", choice.device,
                    "OpenCL device: index, part of a name, cpu, gpu or all (default: $NEARLIGHT_DEVICE, else the first "
                    "GPU, else the first device; see `nearlight devices`)")
        ->type_name("DEVICE");
    command.add_option("--kernel-dir", choice.options.kernel_dir, "Read kernels from this folder instead of the binary")
        ->type_name("DIR");
    command
        .add_option("--cache-dir", choice.options.cache_dir,
                    "Keep compiled kernels here (default: ~/.cache/nearlight); `none` keeps nothing")
        ->type_name("DIR");
}

std::unique_ptr<Device> open_device(const DeviceChoice& choice) {
    const std::vector<DeviceEntry> chosen = choose_devices(list_devices(), choice.device);
    if (chosen.size() > 1) {
        spdlog::warn("{} devices match, one picture is rendered on one: using {} ({})", chosen.size(),
                     chosen.front().name, chosen.front().platform);
    }
    spdlog::debug("device {}: {}, {}, driver {}", chosen.front().index, chosen.front().name, chosen.front().platform,
                  chosen.front().driver);
    return std::make_unique<Device>(chosen.front(), choice.options);
}

}  // namespace nearlight
