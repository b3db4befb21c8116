// SPDX-License-Identifier: Apache-2.0
// The OpenCL devices of this machine, and the choice among them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "nearlight/export.h"

namespace nearlight {

enum class DeviceKind { cpu, gpu, other };

/// Facts about a device, as its driver gives them.
struct DeviceInfo {
    int index = 0;  ///< its number among the devices of all drivers, for Devices::choose()
    std::string name;
    std::string platform;
    std::string version;  ///< the version of OpenCL
    std::string driver;   ///< the version of the driver
    DeviceKind kind = DeviceKind::other;
    unsigned compute_units = 0;
    std::size_t memory_bytes = 0;
    std::string part;              ///< which part of a split device, as in "part 0 of 2"; else empty
    std::string unusable_because;  ///< reason, as the end of a sentence; empty if the device can be used
};

/// All devices of all drivers, unusable ones included; empty if there are none. Does not throw if a driver
/// fails. A process's first call of this function or of Devices::choose() loads the drivers, which takes up
/// to a second, and sets POCL_WORK_GROUP_SPECIALIZATION in the environment unless it is set. If PoCL cannot
/// write its cache folder, or its disk is full, it also sets POCL_CACHE_DIR to a temporary folder, with a
/// warning. No other thread may read or write the environment meanwhile.
NEARLIGHT_API std::vector<DeviceInfo> list_devices();

/// Where devices take kernels from and where they keep compiled ones.
struct DeviceOptions {
    /// Kernels are read from this folder. If it is empty, those that are built into the library are used.
    std::filesystem::path kernel_dir{};
    /// Compiled kernels and trees are kept in this folder, which is created if it does not exist. If it is
    /// empty, they are kept in the folder that NEARLIGHT_CACHE_DIR names in the environment, else in
    /// $XDG_CACHE_HOME/nearlight, else in ~/.cache/nearlight. If it is "none", nothing is kept.
    std::filesystem::path cache_dir{};
};

/// One device or several that work together, opened and ready for work. Copies share the devices, which stay
/// open as long as a copy or a Session uses them. Sessions that share devices must be used by one thread at a
/// time; to work in several threads, choose devices for each, or parts of one device ("0/2.0" and "0/2.1").
class NEARLIGHT_API Devices {
  public:
    /// Opens the devices that `choice` names. It is a list of items with commas between them:
    ///  - "auto" takes what NEARLIGHT_DEVICE in the environment names, else the first GPU, else the first
    ///    device; it must be the only item.
    ///  - "cpu", "gpu", an index, or a part of a name in any case takes the first device that matches.
    ///  - "all" takes every usable device.
    ///  - "X/N" splits each device of the item X into N equal parts, which are devices of their own.
    ///  - "X/N.K" takes the part K of these, counted from 0.
    ///
    /// Throws Error: ErrorKind::no_device if an item matches no device (the message lists the devices), or if
    /// a device does not start.
    static Devices choose(const std::string& choice = "auto", const DeviceOptions& options = {});

    /// Facts about the devices, one or more, in the order of the choice.
    [[nodiscard]] const std::vector<DeviceInfo>& infos() const;

  private:
    friend class Animation;
    friend class Session;
    struct State;
    explicit Devices(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

}  // namespace nearlight
