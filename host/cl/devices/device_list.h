// SPDX-License-Identifier: Apache-2.0
// What OpenCL offers on this machine, and the choice among it.
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nearlight::core {

enum class DeviceKind { cpu, gpu, other };
std::string to_string(DeviceKind kind);

/// One device of one platform. Devices are numbered over all platforms in the order of the drivers.
struct DeviceEntry {
    int index = 0;
    cl::Device handle;
    std::string name;
    std::string platform;
    std::string version;  ///< of the device, e.g. "OpenCL 3.0 PoCL HSTR: …"
    std::string driver;
    DeviceKind kind = DeviceKind::other;
    unsigned compute_units = 0;
    unsigned float_width = 0;  ///< floats of its vectors (CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT)
    std::size_t global_bytes = 0;
    std::size_t max_allocation_bytes = 0;
    unsigned max_parts = 1;        ///< equal parts of one compute unit or more that it can be split in
    std::string part;              ///< of a split device, e.g. "part 0 of 2"; empty for a whole one
    std::string unusable_because;  ///< empty where the device can be used

    /// For messages: the name, and which part of it.
    [[nodiscard]] std::string label() const { return part.empty() ? name : name + " (" + part + ")"; }
};

/// Platforms that are broken or have no device are kept as text, so that `devices` can show them.
struct DeviceList {
    std::vector<DeviceEntry> devices;
    std::vector<std::string> problems;
};
/// Environment variables that drivers read, where they are not set: list_devices() does it too, but must not
/// be the first to where there are threads already.
void set_driver_defaults();
/// To be called before: CPU drivers that can be told (PoCL) take so many threads.
void limit_driver_threads(int threads);
/// Never throws for what drivers do wrong.
DeviceList list_devices();

/// By `choice`, a comma-separated list of: an index, "cpu", "gpu", "all", or part of a name (any case), each
/// with "/N" behind it for N equal parts of the device as devices of their own, or "/N.K" for part K (from 0)
/// alone; empty: NEARLIGHT_DEVICE from the environment, or else the first GPU, or else the first device. Each
/// device comes once. Only "all", lists and parts give several. Throws Error(ErrorKind::no_device) with what
/// to install, or with the devices there are.
std::vector<DeviceEntry> choose_devices(const DeviceList& list, const std::string& choice);

}  // namespace nearlight::core
