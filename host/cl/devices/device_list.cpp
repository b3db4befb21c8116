// SPDX-License-Identifier: Apache-2.0
#include "host/cl/devices/device_list.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <regex>
#include <sstream>

#include "host/base/words.h"
#include "host/cl/devices/driver_cache.h"
#include "host/cl/devices/registered_drivers.h"
#include "host/cl/opencl_error.h"

namespace nearlight::core {
namespace {

constexpr const char* kInstallHint =
    "install a driver: `apt-get install pocl-opencl-icd` runs on any CPU, GPUs need their vendor's OpenCL "
    "package";

std::string trimmed(std::string text) {
    // Some drivers pad names with blanks, and others count the terminating zero.
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) {
        text.pop_back();
    }
    return text;
}

/// Whether a version, such as "OpenCL 3.0 PoCL" or "OpenCL C 1.2", is 1.2 or later.
bool is_recent(const std::string& version) {
    static const std::regex numbers(R"((\d{1,4})\.(\d{1,4}))");
    std::smatch match;
    return !std::regex_search(version, match, numbers) ||
           std::pair(std::stoi(match[1].str()), std::stoi(match[2].str())) >= std::pair(1, 2);
}

/// Asks the device for its properties. Throws cl::Error.
void describe(DeviceEntry& entry) {
    const cl::Device& handle = entry.handle;
    entry.name = trimmed(handle.getInfo<CL_DEVICE_NAME>());
    entry.version = trimmed(handle.getInfo<CL_DEVICE_VERSION>());
    entry.driver = trimmed(handle.getInfo<CL_DRIVER_VERSION>());
    const cl_device_type type = handle.getInfo<CL_DEVICE_TYPE>();
    entry.kind = (type & CL_DEVICE_TYPE_GPU)   ? DeviceKind::gpu
                 : (type & CL_DEVICE_TYPE_CPU) ? DeviceKind::cpu
                                               : DeviceKind::other;
    entry.compute_units = handle.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    entry.float_width = handle.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    entry.global_bytes = handle.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    const auto ways = handle.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
    if (std::find(ways.begin(), ways.end(), CL_DEVICE_PARTITION_EQUALLY) != ways.end()) {
        entry.max_parts = std::max(1u, handle.getInfo<CL_DEVICE_PARTITION_MAX_SUB_DEVICES>());
    }
    entry.max_allocation_bytes = handle.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    if (!handle.getInfo<CL_DEVICE_AVAILABLE>()) {
        entry.unusable_because = "the driver says it is not available";
    } else if (!handle.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) {
        entry.unusable_because = "its driver has no compiler";
    } else if (!handle.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) {
        entry.unusable_because = "it is big-endian";
    } else {
        entry.unusable_because =
            what_kernels_miss({entry.version, trimmed(handle.getInfo<CL_DEVICE_OPENCL_C_VERSION>())},
                              trimmed(handle.getInfo<CL_DEVICE_PROFILE>()));
    }
}

/// Describes a device, whose driver may fail. The device then cannot be used, and others can.
DeviceEntry describe_if_it_answers(const cl::Device& handle, const std::string& platform) {
    DeviceEntry entry;
    entry.handle = handle;
    entry.name = "a device of " + platform;
    entry.platform = platform;
    try {
        describe(entry);
    } catch (const cl::Error& error) {
        entry.unusable_because =
            std::string("its driver fails: ") + error.what() + " gave " + opencl_error_name(error.err());
    }
    return entry;
}

void list_platform(const cl::Platform& platform, DeviceList& list) {
    std::string name = "a platform";
    try {
        name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        std::vector<cl::Device> handles;
        platform.getDevices(CL_DEVICE_TYPE_ALL, &handles);
        if (handles.empty()) {
            list.problems.push_back("platform '" + name + "' has no device");
        }
        for (const cl::Device& handle : handles) {
            DeviceEntry entry = describe_if_it_answers(handle, name);
            entry.index = static_cast<int>(list.devices.size());
            list.devices.push_back(std::move(entry));
        }
    } catch (const cl::Error& error) {
        list.problems.push_back(error.err() == CL_DEVICE_NOT_FOUND
                                    ? "platform '" + name + "' has no device"
                                    : "platform '" + name + "' is broken: " + error.what() + " gave " +
                                          opencl_error_name(error.err()));
    }
}

std::string describe_choices(const DeviceList& list) {
    std::string text;
    for (const DeviceEntry& entry : list.devices) {
        text += (text.empty() ? "" : ", ") + std::to_string(entry.index) + " = " + entry.name;
    }
    return text;
}

/// Splits a device into `part_count` devices with equal numbers of compute units. Units that are left over
/// stay idle.
std::vector<DeviceEntry> split_device(const DeviceEntry& whole, unsigned part_count) {
    if (part_count == 0 || part_count > whole.max_parts) {
        throw Error(ErrorKind::no_device, "OpenCL device '" + whole.name + "' can be split into 1 to " +
                                              std::to_string(whole.max_parts) + " parts, not into " +
                                              std::to_string(part_count));
    }
    const unsigned units = whole.compute_units / part_count;
    const cl_device_partition_property equally[]{CL_DEVICE_PARTITION_EQUALLY, units, 0};
    std::vector<cl::Device> handles;
    with_opencl_errors("splitting device " + whole.name,
                       [&] { cl::Device(whole.handle).createSubDevices(equally, &handles); });
    handles.resize(std::min<std::size_t>(handles.size(), part_count));
    std::vector<DeviceEntry> parts;
    for (std::size_t i = 0; i < handles.size(); ++i) {
        DeviceEntry part = whole;
        part.handle = handles[i];
        part.compute_units = units;
        part.max_parts = 1;
        part.part = "part " + std::to_string(i) + " of " + std::to_string(part_count);
        parts.push_back(std::move(part));
    }
    return parts;
}

bool matches(const DeviceEntry& entry, const std::string& choice) {
    const bool is_index = !choice.empty() && std::all_of(choice.begin(), choice.end(),
                                                         [](unsigned char c) { return std::isdigit(c); });
    if (is_index) {
        return std::to_string(entry.index) == choice;
    }
    if (choice == "all") {
        return entry.unusable_because.empty();
    }
    if (choice == "cpu" || choice == "gpu") {
        return choice == to_string(entry.kind);
    }
    return lower_case(entry.name + " " + entry.platform).find(choice) != std::string::npos;
}

/// The order of preference. What is neither GPU nor CPU is often an emulator for developers.
int rank_of(DeviceKind kind) {
    return kind == DeviceKind::gpu ? 0 : kind == DeviceKind::cpu ? 1 : 2;
}

DeviceEntry default_device(const DeviceList& list) {
    const DeviceEntry* best = nullptr;
    for (const DeviceEntry& entry : list.devices) {
        if (!entry.unusable_because.empty()) {
            continue;
        }
        if (best == nullptr || rank_of(entry.kind) < rank_of(best->kind)) {
            best = &entry;
        }
    }
    if (best == nullptr) {
        const DeviceEntry& first = list.devices.front();
        throw Error(ErrorKind::no_device, "OpenCL device '" + first.name + "' cannot be used: " +
                                              first.unusable_because + "; " + kInstallHint);
    }
    return *best;
}

/// Chooses the whole devices of one item, which has no "/N" or "/N.K".
std::vector<DeviceEntry> choose_whole(const DeviceList& list, const std::string& choice) {
    std::vector<DeviceEntry> chosen;
    std::copy_if(list.devices.begin(), list.devices.end(), std::back_inserter(chosen),
                 [&](const DeviceEntry& entry) { return matches(entry, choice); });
    if (chosen.empty() || choice.empty()) {
        throw Error(ErrorKind::no_device,
                    "no OpenCL device matches '" + choice + "'; there are: " + describe_choices(list));
    }
    std::stable_partition(chosen.begin(), chosen.end(),
                          [](const DeviceEntry& entry) { return entry.unusable_because.empty(); });
    if (const DeviceEntry& first = chosen.front(); !first.unusable_because.empty()) {
        throw Error(ErrorKind::no_device,
                    "OpenCL device '" + first.name + "' cannot be used: " + first.unusable_because);
    }
    if (choice != "all") {
        chosen.resize(1);
    }
    return chosen;
}

/// Chooses the devices of one item, such as "cpu", "cpu/2" or "cpu/2.0".
std::vector<DeviceEntry> choose_item(const DeviceList& list, const std::string& item) {
    static const std::regex with_parts(R"((.+)/(\d{1,4})(\.(\d{1,4}))?)");
    std::smatch match;
    if (!std::regex_match(item, match, with_parts)) {
        return choose_whole(list, item);
    }
    const auto part_count = static_cast<unsigned>(std::stoul(match[2].str()));
    std::vector<DeviceEntry> chosen;
    for (const DeviceEntry& whole : choose_whole(list, match[1].str())) {
        std::vector<DeviceEntry> parts = split_device(whole, part_count);
        if (!match[4].matched) {
            std::move(parts.begin(), parts.end(), std::back_inserter(chosen));
        } else if (const std::size_t index = std::stoul(match[4].str()); index < parts.size()) {
            chosen.push_back(std::move(parts[index]));
        } else {
            throw Error(ErrorKind::no_device,
                        "'" + item + "' names a part that does not exist; parts are numbered from 0 to " +
                            std::to_string(parts.size() - 1));
        }
    }
    return chosen;
}

/// Chooses devices as choose_devices() does. Throws cl::Error too.
std::vector<DeviceEntry> chosen_of(const DeviceList& list, const std::string& requested) {
    if (list.devices.empty()) {
        if (const std::string reason = too_few_files(); !reason.empty()) {
            throw Error(ErrorKind::no_device, "no OpenCL device: " + reason);
        }
        std::vector<std::string> reasons = list.problems;
        std::ranges::move(drivers_that_do_not_load(), std::back_inserter(reasons));
        const std::string why = reasons.empty() ? "no OpenCL platform" : reasons.front();
        throw Error(ErrorKind::no_device, "no OpenCL device (" + why + "); " + kInstallHint);
    }
    std::string choice = lower_case(requested);
    if (const char* variable = std::getenv("NEARLIGHT_DEVICE"); choice.empty() && variable != nullptr) {
        choice = lower_case(variable);
    }
    if (choice.empty()) {
        return {default_device(list)};
    }
    std::vector<DeviceEntry> chosen;
    std::istringstream items(choice);
    for (std::string item; std::getline(items, item, ',');) {
        for (DeviceEntry& entry : choose_item(list, item)) {
            const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const DeviceEntry& other) {
                return other.index == entry.index && other.part == entry.part;
            });
            if (is_new) {
                chosen.push_back(std::move(entry));
            }
        }
    }
    return chosen;
}

}  // namespace

std::string what_kernels_miss(std::initializer_list<std::string> versions, const std::string& profile) {
    for (const std::string& version : versions) {
        if (!is_recent(version)) {
            return "it has " + version + ", and the kernels need 1.2";
        }
    }
    return profile == "FULL_PROFILE" ? "" : "it has OpenCL's profile " + profile + ", not the full one";
}

std::string to_string(DeviceKind kind) {
    return kind == DeviceKind::cpu ? "cpu" : kind == DeviceKind::gpu ? "gpu" : "other";
}

void set_driver_defaults() {
    static std::once_flag once;
    std::call_once(once, [] {
        // PoCL compiles each kernel for any group size when its binary is asked for, and once more for the
        // group size of a launch. The second compilation makes no faster kernel (bench/log/compile.md), and
        // users would wait for it.
        setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
        // PoCL sets this one when it looks for devices, while other threads load the scene. A name that is
        // new moves the list of variables, so that a getenv() of these threads would read freed memory.
        setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0);
        ensure_driver_cache();
    });
}

// PoCL 4 and later use the second name.
void limit_driver_threads(int threads) {
    for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
        setenv(name, std::to_string(threads).c_str(), 1);
    }
}

DeviceList list_devices() {
    set_driver_defaults();
    DeviceList list;
    if (const std::string reason = too_few_files(); !reason.empty()) {
        list.problems.push_back(reason);
        return list;
    }
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        if (error.err() != -1001) {  // CL_PLATFORM_NOT_FOUND_KHR: there is no platform, which is no problem
            list.problems.push_back("the OpenCL loader failed: " + opencl_error_name(error.err()));
        }
    }
    for (const cl::Platform& platform : platforms) {
        list_platform(platform, list);
    }
    return list;
}

std::vector<DeviceEntry> choose_devices(const DeviceList& list, const std::string& requested) {
    return with_opencl_errors("choice among the OpenCL devices", [&] { return chosen_of(list, requested); });
}

}  // namespace nearlight::core
