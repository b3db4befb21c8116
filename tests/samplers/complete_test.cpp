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

namespace nearlight::core {
namespace {

using namespace small_scenes;

class CompleteTest : public test::DeviceTest {};

/// A wall with a normal along z that closes the room at `z`, with an opening of `hole` × `hole` in its
/// middle.
void add_wall(Scene& scene, float z, float hole, uint material) {
    const float rim = 0.5f * (4 - hole);
    add_quad(scene, {-2, 0, z}, {4, 0, 0}, {0, rim, 0}, material);
    add_quad(scene, {-2, 4 - rim, z}, {4, 0, 0}, {0, rim, 0}, material);
    add_quad(scene, {-2, rim, z}, {rim, 0, 0}, {0, hole, 0}, material);
    add_quad(scene, {2 - rim, rim, z}, {rim, 0, 0}, {0, hole, 0}, material);
}

/// A room of 4 × 4 × 4 in the middle of a ground of 160 × 160. The camera looks away from the window.
Scene house_on_grounds() {
    Scene scene;
    const uint wall = add_two_sided(scene, lambertian({0.6f, 0.6f, 0.6f}));
    add_wall(scene, -2, 0, wall);
    add_wall(scene, 2, 1, wall);
    add_quad(scene, {-2, 0, -2}, {0, 4, 0}, {0, 0, 4}, wall);
    add_quad(scene, {2, 0, -2}, {0, 4, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-2, 4, -2}, {4, 0, 0}, {0, 0, 4}, wall);
    add_quad(scene, {-80, 0, -80}, {160, 0, 0}, {0, 0, 160}, wall);
    scene.environment = {.width = 1, .height = 1, .radiance = {{1, 1, 1}}, .to_world = {}};
    set_camera(scene, {0, 2, 1.5}, {0, 2, -2}, 80);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

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

TEST_F(CompleteTest, EverySetHoldsTheLightOfTheRoom) {
    const Scene scene = house_on_grounds();
    constexpr uint kSets = 8;
    on_each_device([&](Device& device) {
        test::SamplingBench bench(device, scene);
        double sum = 0;
        double squares = 0;
        for (uint seed = 0; seed < kSets; ++seed) {
            SamplingTask task = bench.task(SamplerKind::close_range, 1000, seed, 6);
            task.close_range = make_close_range(make_camera(scene.camera, 32, 32), 5.0f);
            const Inside room = inside(sample_vpls(bench.stages(), task).vpls.download());
            EXPECT_LT(room.strongest, 0.05 * room.power) << "seed " << seed;
            sum += room.power / kSets;
            squares += room.power * room.power / kSets;
        }
        EXPECT_LT(std::sqrt(squares - sum * sum), 0.15 * sum);
    });
}

}  // namespace
}  // namespace nearlight::core
