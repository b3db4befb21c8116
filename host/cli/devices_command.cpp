// SPDX-License-Identifier: Apache-2.0
#include "host/cli/devices_command.h"

#include <algorithm>

#include "host/base/log.h"
#include "host/cl/device_list.h"
#include "host/cli/output.h"

namespace nearlight {
namespace {

std::string memory_text(std::size_t bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

bool is_used(const std::vector<DeviceEntry>& used, const DeviceEntry& entry) {
    return std::any_of(used.begin(), used.end(),
                       [&](const DeviceEntry& u) { return u.index == entry.index; });
}

nlohmann::ordered_json to_json(const DeviceList& list, const std::vector<DeviceEntry>& used) {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const DeviceEntry& entry : list.devices) {
        devices.push_back({{"index", entry.index},
                           {"name", entry.name},
                           {"platform", entry.platform},
                           {"kind", to_string(entry.kind)},
                           {"version", entry.version},
                           {"driver", entry.driver},
                           {"compute_units", entry.compute_units},
                           {"global_bytes", entry.global_bytes},
                           {"max_allocation_bytes", entry.max_allocation_bytes},
                           {"max_parts", entry.max_parts},
                           {"usable", entry.unusable_because.empty()},
                           {"unusable_because", entry.unusable_because},
                           {"used", is_used(used, entry)}});
    }
    return {{"devices", devices}, {"problems", list.problems}};
}

void print_text(const DeviceList& list, const std::vector<DeviceEntry>& used) {
    for (const DeviceEntry& entry : list.devices) {
        print(fmt::format("{} {}: {} [{}]\n", is_used(used, entry) ? "*" : " ", entry.index, entry.name,
                          to_string(entry.kind)));
        print(fmt::format("     platform  {}\n     version   {}\n     driver    {}\n", entry.platform,
                          entry.version, entry.driver));
        print(fmt::format("     units     {}, memory {}, largest buffer {}\n", entry.compute_units,
                          memory_text(entry.global_bytes), memory_text(entry.max_allocation_bytes)));
        if (entry.max_parts > 1) {
            print(
                fmt::format("     parts     up to {0}: --device {1}/{0} uses them all, {1}/{0}.0 the first\n",
                            entry.max_parts, entry.index));
        }
        if (!entry.unusable_because.empty()) {
            print(fmt::format("     not usable: {}\n", entry.unusable_because));
        }
    }
    for (const std::string& problem : list.problems) {
        print(fmt::format("  problem: {}\n", problem));
    }
    print(
        "* is what `nearlight render` uses: what --device or NEARLIGHT_DEVICE names (several share a "
        "picture: --device "
        "all, or 0,1), else the first GPU, else the first device.\n");
}

ExitCode run_devices(const std::string& choice, const GlobalOptions& global) {
    const DeviceList list = list_devices();
    const std::vector<DeviceEntry> used = choose_devices(list, choice);
    if (global.json) {
        print_json(to_json(list, used));
    } else {
        print_text(list, used);
    }
    return ExitCode::done;
}

}  // namespace

void add_devices_command(CommandLine& line) {
    auto choice = std::make_shared<std::string>();
    CLI::App& command =
        line.add_command("devices", "List OpenCL platforms and devices, and say which one is used",
                         [choice](const GlobalOptions& global) { return run_devices(*choice, global); });
    command.add_option("--device", *choice, "Mark what this choice would use")->type_name("DEVICE");
}

}  // namespace nearlight
