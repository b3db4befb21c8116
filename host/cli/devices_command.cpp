// SPDX-License-Identifier: Apache-2.0
#include "host/cli/devices_command.h"

#include <algorithm>
#include <iterator>

#include "host/cl/device.h"
#include "host/cl/devices/device_list.h"
#include "host/cl/devices/registered_drivers.h"
#include "host/cli/device_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/tunables_output.h"

namespace nearlight::core {
namespace {

std::string memory_text(std::size_t bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

bool is_used(const std::vector<DeviceEntry>& used, const DeviceEntry& entry) {
    return std::any_of(used.begin(), used.end(),
                       [&](const DeviceEntry& u) { return u.index == entry.index; });
}

struct DevicesOptions {
    std::string choice;
    std::filesystem::path cache_dir;
};

ChosenTunables tunables_of(const DeviceEntry& entry, const std::filesystem::path& cache_dir) {
    return choose_tunables(entry, cache_dir.empty() ? default_cache_dir() : cache_dir, {});
}

nlohmann::ordered_json to_json(const DeviceList& list, const std::vector<DeviceEntry>& used,
                               const std::filesystem::path& cache_dir) {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceEntry& entry : list.devices) {
        devices.push_back({{"index", entry.index},
                           {"name", entry.name},
                           {"platform", entry.platform},
                           {"kind", to_string(entry.kind)},
                           {"version", entry.version},
                           {"driver", entry.driver},
                           {"compute_units", entry.compute_units},
                           {"float_width", entry.float_width},
                           {"global_bytes", entry.global_bytes},
                           {"max_allocation_bytes", entry.max_allocation_bytes},
                           {"max_parts", entry.max_parts},
                           {"usable", entry.unusable_because.empty()},
                           {"unusable_because", entry.unusable_because},
                           {"used", is_used(used, entry)},
                           {"tunables", to_json(tunables_of(entry, cache_dir))}});
    }
    return {{"devices", devices}, {"problems", list.problems}};
}

void print_text(const DeviceList& list, const std::vector<DeviceEntry>& used,
                const std::filesystem::path& cache_dir) {
    for (const DeviceEntry& entry : list.devices) {
        print(fmt::format("{} {}: {} [{}]\n", is_used(used, entry) ? "*" : " ", entry.index, entry.name,
                          to_string(entry.kind)));
        print(fmt::format("     platform  {}\n     version   {}\n     driver    {}\n", entry.platform,
                          entry.version, entry.driver));
        print(fmt::format("     units     {} with vectors of {}, memory {}, maximum buffer {}\n",
                          entry.compute_units, entry.float_width, memory_text(entry.global_bytes),
                          memory_text(entry.max_allocation_bytes)));
        if (entry.max_parts > 1) {
            print(fmt::format(
                "     parts     up to {0}: --device {1}/{0} uses all of them, {1}/{0}.0 only the first\n",
                entry.max_parts, entry.index));
        }
        const ChosenTunables tunables = tunables_of(entry, cache_dir);
        print(
            fmt::format("     tunables  {}\n     from      {}\n", to_text(tunables.values), tunables.source));
        if (!entry.unusable_because.empty()) {
            print(fmt::format("     not usable: {}\n", entry.unusable_because));
        }
    }
    for (const DeviceEntry& entry : list.devices) {
        if (const std::string warning = tunables_of(entry, cache_dir).warning; !warning.empty()) {
            print(fmt::format("  problem: {}\n", warning));
        }
    }
    for (const std::string& problem : list.problems) {
        print(fmt::format("  problem: {}\n", problem));
    }
    print(
        "`nearlight render` uses the devices marked *: those that --device or NEARLIGHT_DEVICE names, or "
        "else the first GPU, CPU or other device. Several devices (--device all, or 0,1) share a "
        "picture.\n");
}

ExitCode run_devices(const DevicesOptions& options, const GlobalOptions& global) {
    DeviceList list = list_devices();
    std::ranges::move(drivers_that_do_not_load(), std::back_inserter(list.problems));
    const std::vector<DeviceEntry> used = choose_devices(list, options.choice);
    if (global.json) {
        print_json(to_json(list, used, options.cache_dir));
    } else {
        print_text(list, used, options.cache_dir);
    }
    return ExitCode::done;
}

}  // namespace

void add_devices_command(CommandLine& line) {
    auto options = std::make_shared<DevicesOptions>();
    CLI::App& command =
        line.add_command("devices", "List OpenCL platforms and devices, and show which are used",
                         [options](const GlobalOptions& global) { return run_devices(*options, global); });
    command.add_option("--device", options->choice, "Mark the devices that this choice would use")
        ->type_name("DEVICE");
    command
        .add_option("--cache-dir", options->cache_dir,
                    std::string("Folder where `nearlight tune` keeps tunables. ") + kDefaultCacheText)
        ->type_name("DIR");
}

}  // namespace nearlight::core
