// SPDX-License-Identifier: Apache-2.0
// A gather's data on a device, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "host/stages/gatherer.h"
#include "host/stages/roulette.h"
#include "tests/support/gather_scenes.h"

namespace nearlight::core::test {

/// The data of a case, on a device.
class Uploaded {
  public:
    Uploaded(Device& device, const GatherCase& data)
        : tree_(upload_both_trees(device, data.bvh)),
          vpls_(device, data.vpls),
          receivers_(device, data.receivers),
          sums_(device, data.receivers.size()),
          roulette_(device),
          clamp_radius_(data.clamp_radius) {
        // The result must not depend on the memory's previous contents.
        sums_.light.upload(std::vector<IrradiancePacket>(data.receivers.size(), garbage()));
    }

    [[nodiscard]] GatherInput<Vpl> input() const {
        return {tree_, vpls_, vpls_.count(), receivers_, receivers_.count(), clamp_radius_};
    }
    /// The light of all VPLs.
    std::vector<IrradiancePacket> gather(Gatherer& gatherer) {
        EXPECT_TRUE(gatherer.gather(input(), sums_));
        return sums_.light.download();
    }
    /// The light of the VPLs of their strata.
    std::vector<IrradiancePacket> gather(Gatherer& gatherer, const VplStrata& strata) {
        GatherInput<Vpl> task = input();
        task.strata = &strata;
        EXPECT_TRUE(gatherer.gather(task, sums_));
        return sums_.light.download();
    }
    /// The light of the VPLs that the roulette chooses.
    std::vector<IrradiancePacket> gather(Gatherer& gatherer, float threshold, uint seed,
                                         const VplStrata* strata = nullptr) {
        const VplSelection selection = select(threshold, seed, strata);
        GatherInput<Vpl> task = input();
        task.strata = strata;
        task.selection = &selection;
        EXPECT_TRUE(gatherer.gather(task, sums_));
        return sums_.light.download();
    }
    [[nodiscard]] VplSelection select(float threshold, uint seed, const VplStrata* strata = nullptr) {
        return roulette_.select({.vpls = vpls_,
                                 .vpl_count = vpls_.count(),
                                 .receivers = receivers_,
                                 .packet_count = receivers_.count(),
                                 .strata = strata,
                                 .clamp_radius = clamp_radius_,
                                 .threshold = threshold,
                                 .seed = seed});
    }
    [[nodiscard]] GatherSums<Vpl>& sums() { return sums_; }

  private:
    static IrradiancePacket garbage() {
        IrradiancePacket packet;
        std::fill_n(packet.r, 3 * NEARLIGHT_PACKET_SIZE, std::nanf(""));
        return packet;
    }

    DeviceTree tree_;
    Buffer<Vpl> vpls_;
    Buffer<ReceiverPacket> receivers_;
    GatherSums<Vpl> sums_;
    Roulette roulette_;
    float clamp_radius_;
};

inline bool same_bits(const std::vector<IrradiancePacket>& a, const std::vector<IrradiancePacket>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(IrradiancePacket)) == 0);
}

/// Expects the same bits of `gather(data, gatherer)`, whether it is done in one launch or in many, and with
/// or without the packets before the last two.
template <typename Gather>
void expect_same_bits_for_any_division(Device& device, const GatherCase& data, const Gather& gather) {
    GatherCase last = data;
    last.receivers.erase(last.receivers.begin(), last.receivers.end() - 2);
    for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
        Gatherer gatherer(device, {.kernel = kernel});
        Gatherer step_by_step(device, {.kernel = kernel, .first_launch_pairs = 1, .launch_seconds = 1e-9});
        std::vector<IrradiancePacket> whole = gather(data, gatherer);
        EXPECT_TRUE(same_bits(whole, gather(data, step_by_step)));
        whole.erase(whole.begin(), whole.end() - 2);
        EXPECT_TRUE(same_bits(whole, gather(last, gatherer)));
    }
}

}  // namespace nearlight::core::test
