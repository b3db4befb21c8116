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
    int index = 0;  ///< over all drivers; Devices::choose() takes it
    std::string name;
    std::string platform;
    std::string version;  ///< of OpenCL
    std::string driver;   ///< version of the driver
    DeviceKind kind = DeviceKind::other;
    unsigned compute_units = 0;
    std::size_t memory_bytes = 0;
    std::string part;              ///< of a device that was split, as in "part 0 of 2"; else empty
    std::string unusable_because;  ///< empty where the device can be used
};

/// All devices of all drivers, those that cannot be used included; empty where there are none. Never throws
/// for what drivers do wrong. The first call of a process, here or of Devices::choose(), loads the drivers,
/// which takes up to a second, and sets POCL_WORK_GROUP_SPECIALIZATION in the environment unless it is set:
/// no other thread may read or write the environment meanwhile.
NEARLIGHT_API std::vector<DeviceInfo> list_devices();

/// What devices use besides their drivers.
struct DeviceOptions {
    /// Kernels are read from this folder; empty: those that are built into the library.
    std::filesystem::path kernel_dir{};
    /// Compiled kernels and trees are kept in this folder, which is made if need be; empty: the one that
    /// NEARLIGHT_CACHE_DIR names in the environment, else $XDG_CACHE_HOME/nearlight, else ~/.cache/nearlight.
    /// "none": nothing is kept.
    std::filesystem::path cache_dir{};
};

/// One device or several that work together, ready for work. Copies share them, and they live as long as the
/// last copy or Session. Sessions that share devices must be used by one thread at a time; for work in
/// several threads choose devices for each, or parts of one device ("0/2.0" and "0/2.1").
class NEARLIGHT_API Devices {
  public:
    /// Which devices, by `choice`:
    ///  - "auto": the ones that NEARLIGHT_DEVICE in the environment chooses, else the first GPU, else the
    ///  first
    ///    device;
    ///  - "cpu", "gpu", an index, or a part of a name in any case: one device;
    ///  - "all": every usable device;
    ///  - "X/N" with any of the above for X: N equal parts of the device as devices of their own, "X/N.K" the
    ///    part K of these, counted from 0;
    ///  - several of these with commas between them.
    /// Throws Error: ErrorKind::no_device where none matches (the message lists those that there are), or
    /// where one does not start.
    static Devices choose(const std::string& choice = "auto", const DeviceOptions& options = {});

    /// One or more, in the order of the choice.
    [[nodiscard]] const std::vector<DeviceInfo>& infos() const;

  private:
    friend class Session;
    struct State;
    explicit Devices(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

}  // namespace nearlight
