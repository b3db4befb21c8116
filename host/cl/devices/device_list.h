// SPDX-License-Identifier: Apache-2.0
// The OpenCL devices of this machine, and the choice among them.
#pragma once

#include <CL/opencl.hpp>
#include <initializer_list>
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
    std::string version;  ///< OpenCL version of the device, e.g. "OpenCL 3.0 PoCL HSTR: …"
    std::string driver;   ///< version of the driver
    DeviceKind kind = DeviceKind::other;
    unsigned compute_units = 0;
    unsigned float_width = 0;  ///< floats per vector (CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT)
    std::size_t global_bytes = 0;
    std::size_t max_allocation_bytes = 0;
    unsigned max_parts = 1;  ///< maximum number of equal parts that it can be split into
    std::string part;        ///< which part of a split device, e.g. "part 0 of 2"; empty for a whole device
    std::string unusable_because;  ///< reason, as the end of a sentence; empty if the device can be used

    /// The name for messages, including the part.
    [[nodiscard]] std::string label() const { return part.empty() ? name : name + " (" + part + ")"; }
};

/// All devices, and as text the platforms that are broken or have no device, so that the command `devices`
/// can show them.
struct DeviceList {
    std::vector<DeviceEntry> devices;
    std::vector<std::string> problems;
};
/// Sets environment variables that drivers read or set, unless they are set; does nothing when it is called
/// again. list_devices() calls it too, but if the process has several threads, this must be called before
/// they start.
void set_driver_defaults();
/// Limits the threads of CPU drivers that allow it (PoCL). Must be called before list_devices().
void limit_driver_threads(int threads);
/// Why the kernels cannot be built for a device with these versions of OpenCL and OpenCL C, such as
/// "OpenCL 3.0 PoCL", and this profile; empty if they can. Versions that cannot be read count as recent.
std::string what_kernels_miss(std::initializer_list<std::string> versions, const std::string& profile);
/// Lists all devices of all platforms. Errors of drivers become problems in the list and are not thrown.
DeviceList list_devices();

/// Chooses devices by `choice`, a list of items with commas between them. An item is an index, "cpu", "gpu",
/// "all", or part of a name in any case. Each can end in "/N", which takes N equal parts of the device as
/// devices of their own, or in "/N.K", which takes only part K, counted from 0. An empty choice takes
/// NEARLIGHT_DEVICE from the environment, else the first GPU, else the first CPU, else the first device. Each
/// device comes once; only "all", lists and parts give several devices. Throws Error(ErrorKind::no_device),
/// which says what to do, or lists the devices.
std::vector<DeviceEntry> choose_devices(const DeviceList& list, const std::string& choice);

}  // namespace nearlight::core
