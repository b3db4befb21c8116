// SPDX-License-Identifier: Apache-2.0
// The kernels and beam widths that the tests of the gatherer run, and the comparison of irradiance.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/stages/gatherer.h"

namespace nearlight::core::test {

struct Variant {
    std::string name;
    GatherConfig config;
};

inline std::vector<Variant> variants() {
    return {
        {"packets of 256", {GatherKernel::packets, 256}}, {"packets of 128", {GatherKernel::packets, 128}},
        {"packets of 64", {GatherKernel::packets, 64}},   {"packets of 32", {GatherKernel::packets, 32}},
        {"packets of 16", {GatherKernel::packets, 16}},   {"rays", {GatherKernel::rays, 64}}};
}

inline void expect_close(const std::vector<IrradiancePacket>& actual,
                         const std::vector<IrradiancePacket>& expected) {
    for (std::size_t p = 0; p < expected.size(); ++p) {
        for (std::size_t i = 0; i < 3 * NEARLIGHT_PACKET_SIZE; ++i) {
            const float want = (&expected[p].r[0])[i];
            // All terms are positive, so rounding stays relative; cosines near zero lose some digits.
            ASSERT_NEAR((&actual[p].r[0])[i], want, 2e-5f * want + 1e-9f) << "packet " << p << " entry " << i;
        }
    }
}

}  // namespace nearlight::core::test
