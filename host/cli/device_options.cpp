// SPDX-License-Identifier: Apache-2.0
#include "host/cli/device_options.h"

#include "host/base/log.h"
#include "host/cl/compile/program_compiler.h"

namespace nearlight::core {

void add_device_options(CLI::App& command, DeviceChoice& choice) {
    command
        .add_option(
            "--device", choice.device,
            "OpenCL devices, comma-separated: index, part of a name, cpu, gpu or all; 0/2 are two halves of "
            "device 0, "
            "0/2.1 the second of them. `render` shares a picture among several (default: $NEARLIGHT_DEVICE, "
            "else the first GPU, else the first device; see `nearlight devices`)")
        ->type_name("DEVICE");
    command
        .add_option("--kernel-dir", choice.options.kernel_dir,
                    "Read kernels from this folder instead of the binary")
        ->type_name("DIR");
    command
        .add_option("--cache-dir", choice.options.cache_dir,
                    "Keep compiled kernels, trees and tunables here (default: ~/.cache/nearlight); `none` "
                    "keeps nothing")
        ->type_name("DIR");
}

DeviceChoice with_compile_workers(DeviceChoice choice) {
    choice.options.compiler = std::make_shared<ProgramCompiler>(start_compile_workers());
    return choice;
}

std::vector<std::unique_ptr<Device>> open_devices(const DeviceChoice& choice, const DeviceList& list) {
    DeviceOptions options = choice.options;
    if (options.compiler == nullptr) {
        options.compiler = std::make_shared<ProgramCompiler>();
    }
    std::vector<std::unique_ptr<Device>> devices;
    for (const DeviceEntry& entry : choose_devices(list, choice.device)) {
        spdlog::debug("device {}: {}, {}, driver {}", entry.index, entry.label(), entry.platform,
                      entry.driver);
        devices.push_back(std::make_unique<Device>(entry, options));
    }
    return devices;
}

std::unique_ptr<Device> open_device(const DeviceChoice& choice) {
    const std::vector<DeviceEntry> chosen = choose_devices(list_devices(), choice.device);
    if (chosen.size() > 1) {
        spdlog::warn("{} devices match, this command works on one: using {} ({})", chosen.size(),
                     chosen.front().label(), chosen.front().platform);
    }
    spdlog::debug("device {}: {}, {}, driver {}", chosen.front().index, chosen.front().label(),
                  chosen.front().platform, chosen.front().driver);
    return std::make_unique<Device>(chosen.front(), choice.options);
}

}  // namespace nearlight::core
