// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_order.h"

#include <algorithm>
#include <cstring>

#include "host/base/random.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class VplOrderTest : public test::DeviceTest {};

/// VPLs whose depths identify them.
std::vector<Vpl> random_vpls(uint count) {
    Pcg32 random(1);
    std::vector<Vpl> vpls(count);
    for (uint i = 0; i < count; ++i) {
        const float x = random.uniform();
        const float y = 3 * random.uniform();
        vpls[i].position = {x, y, 2 * random.uniform()};
        vpls[i].depth = i;
        vpls[i].power = {random.uniform(), 1, 2};
    }
    return vpls;
}

TEST_F(VplOrderTest, IsAPermutationAlongTheMortonCurve) {
    on_each_device([](Device& device) {
        for (const uint count : {0u, 1u, 2u, 1000u}) {
            const std::vector<Vpl> vpls = random_vpls(count);
            const VplBuffer sorted = VplOrder(device).sort(vpls);
            const std::vector<Vpl> result = sorted.download();
            ASSERT_EQ(result.size(), count);
            std::vector<bool> seen(count);
            for (const Vpl& vpl : result) {
                ASSERT_LT(vpl.depth, count);
                ASSERT_FALSE(seen[vpl.depth]);
                seen[vpl.depth] = true;
                EXPECT_EQ(std::memcmp(&vpl, &vpls[vpl.depth], sizeof(Vpl)), 0);
            }
            MortonSort morton(device);
            Buffer<uint> codes(device, count);
            Buffer<uint> values(device, count);
            morton.codes(sorted.buffer(), count, morton.bounds(sorted.buffer(), count), codes, values);
            const std::vector<uint> along = codes.download();
            EXPECT_TRUE(std::is_sorted(along.begin(), along.end()));
        }
    });
}

}  // namespace
}  // namespace nearlight::core
