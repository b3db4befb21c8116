// SPDX-License-Identifier: Apache-2.0
// What single VPLs bring to a point. tests/library/light_shares_test.cpp compares whole sets with the
// irradiance.
#include "host/session/light_shares.h"

#include <gtest/gtest.h>

#include "host/base/packed_direction.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

class SharesOfVpls : public test::DeviceTest {};

TEST_F(SharesOfVpls, AVplSeenFromBehindItsShadingNormalBringsNothing) {
    using namespace small_scenes;
    Scene ground;
    add_quad(ground, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(ground, lambertian({0.5f, 0.5f, 0.5f})));
    add_point_light(ground, {0, 0, 3}, {1, 1, 1});
    const Vpl plain{.position = {0, 0, 1},
                    .depth = 1,
                    .normal = {0, 0, -1},
                    .flags = 0,
                    .power = {1, 2, 3},
                    .shading = 0};
    Vpl from_behind = plain;
    from_behind.flags = NEARLIGHT_VPL_TILTED;
    from_behind.shading = pack_direction(normalize(Vec3{1, 0, 0.2f}));
    Vpl leaning = from_behind;
    leaning.shading = pack_direction(normalize(Vec3{1, 0, -0.2f}));
    on_each_device([&](Device& device) {
        const test::SceneOnDevice scene(device, ground);
        const std::vector<LightShare> shares =
            light_shares(device, scene.buffers, scene.scene, std::vector{plain, from_behind, leaning},
                         {.position = {0, 0, 0}, .normal = {0, 0, 1}, .clamp_radius = 2.0f});
        ASSERT_GE(shares.size(), 3u);
        // A power Φ sends the intensity Φ/π along the normal; over 1 m, the clamp radius of 2 m takes 3/4 of
        // it.
        for (const std::size_t seen : {0u, 2u}) {
            EXPECT_NEAR(shares[seen].irradiance.y, 0.25f * 2 / kPi, 1e-3f) << seen;
            EXPECT_NEAR(shares[seen].taken_by_clamp.y, 0.75f * 2 / kPi, 1e-3f) << seen;
        }
        EXPECT_EQ(shares[1].irradiance.y, 0.0f);
        EXPECT_EQ(shares[1].taken_by_clamp.y, 0.0f);
    });
}

}  // namespace
}  // namespace nearlight::core
