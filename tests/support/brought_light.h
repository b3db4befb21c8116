// SPDX-License-Identifier: Apache-2.0
// Light that rays bring to receivers over surfaces, each by its own rays or by those of its bundle.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "host/base/receivers.h"
#include "host/bvh/bvh.h"
#include "host/stages/device_scene.h"
#include "host/stages/receiver_paths.h"
#include "host/stages/shared_lights.h"
#include "host/stages/shared_reflections.h"
#include "host/stages/shared_veiled.h"

namespace nearlight::core::test {

/// Green light that rays bring to each receiver, in the mean over some seeds, and the mean of its squares.
struct Brought {
    std::vector<double> mean, square;
    [[nodiscard]] double sum() const {
        double sum = 0;
        for (const double value : mean) {
            sum += value;
        }
        return sum;
    }
    [[nodiscard]] double variance() const {
        double sum = 0;
        for (std::size_t i = 0; i < mean.size(); ++i) {
            sum += square[i] - mean[i] * mean[i];
        }
        return sum;
    }
};

/// Settings by which bundles get at most this radiance of a lamp that a path met by chance.
inline ReceiverPathSettings with_limit(ReceiverPathSettings settings, float limit) {
    settings.shared_limit = limit;
    return settings;
}

/// Light over surfaces; what the settings say is left to the bundle if it is `shared`.
inline Brought brought(Device& device, const Scene& scene, const std::vector<ReceiverPacket>& packets,
                       bool shared, ReceiverPathSettings settings, uint seeds,
                       GatherKernel kernel = GatherKernel::automatic) {
    const Bvh bvh = build_scene_bvh(scene);
    const DeviceScene on_device = upload_scene(device, scene, bvh, kernel);
    const Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<IrradiancePacket> direct(device, packets.size());
    Buffer<IrradiancePacket> indirect(device, packets.size());
    FoundLights found(device, packets.size(), settings);
    ReceiverPaths paths(device);
    SharedLightLists lists(device, kernel);
    SharedLights lights(device);
    SharedReflections reflections(device);
    SharedVeiled veiled(device);
    const std::size_t count = packets.size() * NEARLIGHT_PACKET_SIZE;
    Brought result{std::vector<double>(count), std::vector<double>(count)};
    for (uint seed = 0; seed < seeds; ++seed) {
        settings.seed = 100 + seed;
        const ReceiverBatch batch{on_device, receivers, packets.size(), settings};
        if (shared) {
            paths.run_sharing(batch, direct, indirect, found);
            lights.add(batch, lists, found.near, indirect);
            if (settings.shares_reflections) {
                reflections.add(batch, lists, found, indirect);
            }
            if (settings.shares_veiled) {
                veiled.add(batch, lists, found.veiled, indirect);
            }
        } else {
            paths.run(batch, direct, indirect);
        }
        const std::vector<IrradiancePacket> light = indirect.download();
        for (std::size_t i = 0; i < count; ++i) {
            const double green = irradiance_at(light, i).y;
            result.mean[i] += green / seeds;
            result.square[i] += green * green / seeds;
        }
    }
    return result;
}

/// Expects that rays of bundles bring the same bits whether one work-item takes a bundle, as on CPUs, or many
/// divide it, as on GPUs.
inline void expect_same_by_any_division(const Device& shared, const Scene& scene,
                                        const std::vector<ReceiverPacket>& packets,
                                        const ReceiverPathSettings& settings) {
    const auto by_items = [&](std::uint32_t items) {
        Device device(shared.entry(), shared.options());
        Tunables tunables = shared.tunables();
        tunables.bundle_local_size = items;
        device.set_tunables(tunables);
        return brought(device, scene, packets, true, settings, 1).mean;
    };
    EXPECT_EQ(by_items(64), by_items(1));
}

}  // namespace nearlight::core::test
