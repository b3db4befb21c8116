// SPDX-License-Identifier: Apache-2.0
// A gather's data on a device, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "host/stages/gatherer.h"
#include "tests/support/gather_scenes.h"

namespace nearlight::core::test {

/// The data of a case, on a device.
class Uploaded {
  public:
    Uploaded(Device& device, const GatherCase& data)
        : tree_(upload_both_trees(device, data.bvh)),
          vpls_(device, data.vpls),
          receivers_(device, data.receivers),
          // Whatever the memory holds must not matter.
          irradiance_(device, std::vector<IrradiancePacket>(data.receivers.size(), garbage())),
          clamp_radius_(data.clamp_radius) {}

    [[nodiscard]] GatherInput input() const {
        return {tree_, vpls_, vpls_.count(), receivers_, receivers_.count(), clamp_radius_};
    }
    std::vector<IrradiancePacket> gather(Gatherer& gatherer, float roulette = 0.0f, uint seed = 0) {
        GatherInput task = input();
        task.roulette = roulette;
        task.seed = seed;
        EXPECT_TRUE(gatherer.gather(task, irradiance_));
        return irradiance_.download();
    }
    [[nodiscard]] Buffer<IrradiancePacket>& irradiance() { return irradiance_; }

  private:
    static IrradiancePacket garbage() {
        IrradiancePacket packet;
        std::fill_n(packet.r, 3 * NEARLIGHT_PACKET_SIZE, std::nanf(""));
        return packet;
    }

    DeviceTree tree_;
    Buffer<Vpl> vpls_;
    Buffer<ReceiverPacket> receivers_;
    Buffer<IrradiancePacket> irradiance_;
    float clamp_radius_;
};

inline bool same_bits(const std::vector<IrradiancePacket>& a, const std::vector<IrradiancePacket>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(IrradiancePacket)) == 0);
}

}  // namespace nearlight::core::test
