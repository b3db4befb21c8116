// SPDX-License-Identifier: Apache-2.0
#include "nearlight/device.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "host/cl/devices/device_list.h"
#include "host/library/states.h"

namespace nearlight {
namespace {

DeviceKind public_kind(core::DeviceKind kind) {
    return kind == core::DeviceKind::cpu   ? DeviceKind::cpu
           : kind == core::DeviceKind::gpu ? DeviceKind::gpu
                                           : DeviceKind::other;
}

DeviceInfo describe_entry(const core::DeviceEntry& entry) {
    return {.index = entry.index,
            .name = entry.name,
            .platform = entry.platform,
            .version = entry.version,
            .driver = entry.driver,
            .kind = public_kind(entry.kind),
            .compute_units = entry.compute_units,
            .memory_bytes = entry.global_bytes,
            .part = entry.part,
            .unusable_because = entry.unusable_because};
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const core::DeviceEntry& entry : core::list_devices().devices) {
        infos.push_back(describe_entry(entry));
    }
    return infos;
}

std::vector<core::Device*> Devices::State::plain() const {
    std::vector<core::Device*> result;
    for (const auto& device : devices) {
        result.push_back(device.get());
    }
    return result;
}

Devices::Devices(std::shared_ptr<State> state) : state_(std::move(state)) {}

Devices Devices::choose(const std::string& choice, const DeviceOptions& options) {
    const core::DeviceOptions core_options{.kernel_dir = options.kernel_dir, .cache_dir = options.cache_dir};
    auto state = std::make_shared<State>();
    state->devices = core::open_devices(
        core::choose_devices(core::list_devices(), choice == "auto" ? "" : choice), core_options);
    std::ranges::transform(state->devices, std::back_inserter(state->infos),
                           [](const auto& device) { return describe_entry(device->entry()); });
    return Devices(std::move(state));
}

const std::vector<DeviceInfo>& Devices::infos() const {
    return state_->infos;
}

}  // namespace nearlight
