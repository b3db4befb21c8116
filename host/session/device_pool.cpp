// SPDX-License-Identifier: Apache-2.0
#include "host/session/device_pool.h"

#include <algorithm>

#include "host/base/message.h"
#include "host/stages/caustic_aims.h"

namespace nearlight::core {
namespace {

/// All pictures of a scene aim at the same places, whatever their seeds.
constexpr uint kCausticSeed = 0x0ca5u;

}  // namespace

DevicePool::DevicePool(std::span<Device* const> devices, GatherKernel kernel) : kernel_(kernel) {
    for (Device* device : devices) {
        try {
            devices_.push_back(std::make_unique<PoolDevice>(*device, kernel));
        } catch (const Error& error) {
            if (devices_.empty() && device == devices.back()) {
                throw;
            }
            say_lost_device(device->entry().label(), error.what());
        }
    }
    on_leader([](const PoolDevice&) {});  // its stages begin to compile
}

std::size_t DevicePool::cpu_count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(devices_, [](const auto& device) { return device->device().is_cpu(); }));
}

TreeShapes DevicePool::tree_shapes() const {
    TreeShapes all;
    for (const auto& device : devices_) {
        const TreeShapes shapes = core::tree_shapes(device->device(), kernel_);
        all = {.binary = all.binary || shapes.binary, .wide = all.wide || shapes.wide};
    }
    return all;
}

void DevicePool::upload(const Scene& scene, const ShapedBvh& tree) {
    for (std::size_t i = devices_.size(); i-- > 0;) {
        try {
            PoolDevice& device = *devices_[i];
            device.scene = upload_scene(device.device(), scene, tree, kernel_);
            if (device.scene.has_mirrors) {
                device.scene.caustic_aims = find_caustic_aims(device.device(), device.scene, kCausticSeed);
            }
            device.bands.expect(device.scene);
        } catch (const Error& error) {
            lose(i, error);
        }
    }
}

void DevicePool::drop_failed(std::span<const BandShare> shares) {
    for (std::size_t i = shares.size(); i-- > 0;) {
        if (shares[i].failed && devices_.size() > 1) {
            drop(i);
        }
    }
}

std::size_t DevicePool::peak_bytes() const {
    std::size_t bytes = 0;
    for (const auto& device : devices_) {
        bytes += device->device().peak_bytes();
    }
    return bytes;
}

/// Drops a device that failed with `error`. Must be called while `error` is being handled, because it is
/// rethrown if there is no other device.
void DevicePool::lose(std::size_t index, const Error& error) {
    if (devices_.size() == 1) {
        throw;
    }
    say_lost_device(devices_[index]->device().entry().label(), error.what());
    drop(index);
}

void DevicePool::drop(std::size_t index) {
    devices_.erase(devices_.begin() + static_cast<std::ptrdiff_t>(index));
}

void DevicePool::appoint_leader() {
    if (!leader().samplers) {
        leader().samplers.emplace(leader().device(), GatherConfig{.kernel = kernel_});
    }
}

}  // namespace nearlight::core
