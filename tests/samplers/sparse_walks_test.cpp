// SPDX-License-Identifier: Apache-2.0
// A walk leaves more or fewer than one VPL, and how many is known only when it has been walked. Samplers
// whose VPLs are those of walks must still make about as many as they are asked for.
#include <gtest/gtest.h>

#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class WalkCountTest : public test::DeviceTest {};

TEST_F(WalkCountTest, WalksLeaveAboutAsManyVplsAsWanted) {
    on_each_device([](Device& device) {
        test::SamplingBench bench(device, test::divided_room());
        for (const SamplerKind sampler : {SamplerKind::instant_radiosity, SamplerKind::local}) {
            for (const uint wanted : {100u, 1000u}) {
                double count = 0;
                for (uint seed = 0; seed < 8; ++seed) {
                    count += static_cast<double>(bench.sample(sampler, wanted, seed).vpls.count()) / 8;
                }
                EXPECT_NEAR(count, wanted, 0.1 * wanted) << to_string(sampler);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
