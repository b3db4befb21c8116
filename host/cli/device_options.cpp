// SPDX-License-Identifier: Apache-2.0
#include "host/cli/device_options.h"

#include "host/cl/compile/program_compiler.h"
#include "host/cli/log.h"

namespace nearlight::core {

void add_device_options(CLI::App& command, DeviceChoice& choice) {
    command
        .add_option(
            "--device", choice.device,
            "OpenCL devices, comma-separated: an index, a part of a name, cpu, gpu or all. 0/2 means "
            "both halves of device 0, and 0/2.1 its second half. `render` and `view` divide a picture "
            "among several devices. The default is $NEARLIGHT_DEVICE, or else the first GPU, CPU or "
            "other device (see `nearlight devices`)")
        ->type_name("DEVICE");
    command
        .add_option("--kernel-dir", choice.options.kernel_dir,
                    "Read kernels from this folder instead of the built-in ones")
        ->type_name("DIR");
    command
        .add_option("--cache-dir", choice.options.cache_dir,
                    std::string("Folder for compiled kernels, trees and tunables; `none` keeps nothing. ") +
                        kDefaultCacheText)
        ->type_name("DIR");
}

void warn_of_cache_file(const DeviceChoice& choice) {
    const std::filesystem::path& given = choice.options.cache_dir;
    const std::filesystem::path folder = given.empty() ? default_cache_dir() : given;
    std::error_code ignored;
    if (given != "none" && std::filesystem::exists(folder, ignored) &&
        !std::filesystem::is_directory(folder, ignored)) {
        spdlog::warn("'{}' is no folder, so nothing is kept; see --cache-dir", folder.string());
    }
}

DeviceChoice with_compile_workers(DeviceChoice choice) {
    warn_of_cache_file(choice);
    set_driver_defaults();
    choice.options.compiler = std::make_shared<ProgramCompiler>(start_compile_workers());
    return choice;
}

std::vector<std::unique_ptr<Device>> open_devices(const DeviceChoice& choice, const DeviceList& list) {
    return open_devices(choose_devices(list, choice.device), choice.options);
}

std::unique_ptr<Device> open_device(const DeviceChoice& choice) {
    std::vector<DeviceEntry> chosen = choose_devices(list_devices(), choice.device);
    if (chosen.size() > 1) {
        spdlog::warn("{} devices match, but this command uses only one: {} ({})", chosen.size(),
                     chosen.front().label(), chosen.front().platform);
    }
    chosen.resize(1);
    return std::move(open_devices(chosen, choice.options).front());
}

}  // namespace nearlight::core
