// SPDX-License-Identifier: Apache-2.0
// A room with a window on wide grounds under the sky: nearly all light falls outside, and what little comes
// in must be spread over many VPLs, in every set alike.
#include "host/samplers/complete.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"
#include "tests/support/house_on_grounds.h"

namespace nearlight::core {
namespace {

class CompleteTest : public test::DeviceTest {};

/// The VPLs within the room.
struct Inside {
    double power = 0;      // W
    double strongest = 0;  // W
};

Inside inside(const std::vector<Vpl>& vpls) {
    Inside result;
    for (const Vpl& vpl : vpls) {
        const Vec3 p = vpl.position;
        if (std::max(std::abs(p.x), std::abs(p.z)) < 2 && p.y > 0 && p.y < 4) {
            result.power += vpl.power.y;
            result.strongest = std::max<double>(result.strongest, vpl.power.y);
        }
    }
    return result;
}

/// The light in the room, over several sets.
struct Steadiness {
    double mean = 0;       // W
    double deviation = 0;  // the standard deviation, W
    double strongest = 0;  // VPL, as a part of its set
};

Steadiness steadiness(Device& device, std::span<const Opening> openings) {
    constexpr uint kSets = 8;
    const Scene scene = test::house_on_grounds(1);
    test::SamplingBench bench(device, scene);
    Steadiness result;
    double squares = 0;
    for (uint seed = 0; seed < kSets; ++seed) {
        SamplingTask task = bench.task(SamplerKind::close_range, 1000, seed, 6);
        task.close_range = make_close_range(make_camera(scene.camera, 32, 32), 5.0f);
        task.openings = openings;
        const Inside room = inside(sample_vpls(bench.stages(), task).vpls.download());
        result.mean += room.power / kSets;
        squares += room.power * room.power / kSets;
        result.strongest = std::max(result.strongest, room.strongest / room.power);
    }
    result.deviation = std::sqrt(squares - result.mean * result.mean);
    return result;
}

TEST_F(CompleteTest, EverySetHoldsTheLightOfTheRoom) {
    on_each_device([&](Device& device) {
        const Steadiness room = steadiness(device, {});
        EXPECT_LT(room.strongest, 0.05);
        EXPECT_LT(room.deviation, 0.15 * room.mean);
    });
}

TEST_F(CompleteTest, WalksThroughTheWindowSteadyTheLight) {
    const Opening window{.center = test::kHouseWindow, .radius = 0.5f, .outwards = {0, 0, 1}, .share = 1};
    on_each_device([&](Device& device) {
        const Steadiness without = steadiness(device, {});
        const Steadiness with = steadiness(device, {&window, 1});
        EXPECT_LT(with.strongest, 0.05);
        EXPECT_LT(with.deviation, 0.05 * with.mean);
        const double error = std::hypot(without.deviation, with.deviation) / std::sqrt(7.0);
        EXPECT_NEAR(with.mean, without.mean, 4 * error);
    });
}

}  // namespace
}  // namespace nearlight::core
