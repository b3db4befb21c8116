// SPDX-License-Identifier: Apache-2.0
// A walk leaves more or fewer than one VPL, and how many is known only when it has been walked. Samplers
// whose VPLs are those of walks must still make about as many as they are asked for, of about equal power.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class SparseWalksTest : public test::DeviceTest {};

/// The divided room in white, on a ground of a hundred times its area that is almost black.
Scene white_room_on_dark_ground() {
    using namespace small_scenes;
    Scene scene = test::divided_room();
    scene.materials.front().reflectance = parameter_of({0.9f, 0.9f, 0.9f});
    add_quad(scene, {-30, -3, -30}, {0, 0, 60}, {60, 0, 0},
             add_material(scene, lambertian({0.05f, 0.05f, 0.05f})));
    return scene;
}

TEST_F(SparseWalksTest, LeaveAboutAsManyVplsAsWanted) {
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

TEST_F(SparseWalksTest, VplsGainNoPowerAmongSurfacesThatAreBrighterThanMost) {
    on_each_device([](Device& device) {
        test::SamplingBench bench(device, white_room_on_dark_ground());
        constexpr uint kDepth = 12;
        for (uint seed = 0; seed < 4; ++seed) {
            const VplSet set = bench.sample(SamplerKind::instant_radiosity, 1000, seed, kDepth);
            const std::vector<Vpl> vpls = set.vpls.download();
            EXPECT_NEAR(static_cast<double>(vpls.size()), 1000, 150);
            const auto power = [](const Vpl& vpl) { return vpl.power.y; };
            const auto [weakest, strongest] = std::ranges::minmax(vpls, {}, power);
            EXPECT_LT(strongest.power.y, 1.5f * weakest.power.y);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
