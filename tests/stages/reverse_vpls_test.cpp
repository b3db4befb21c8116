// SPDX-License-Identifier: Apache-2.0
#include "host/stages/reverse_vpls.h"

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/scene/ray_epsilon.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class ReverseVplsTest : public test::DeviceTest {};

constexpr uint kPoints = 60;
constexpr float kExtent = 2.0f;

/// A closed room, [−1, 1]³, of one albedo a wall, with a block in it that hides parts from parts. The block's
/// sides face outwards; its back is of no interest, for nothing sees it.
Scene room_with_block() {
    Scene scene;
    const auto wall = [&](float r) { return add_material(scene, lambertian({r, 0.5f, 0.25f})); };
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, wall(0.1f));
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, wall(0.2f));
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, wall(0.3f));
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, wall(0.4f));
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, wall(0.5f));
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, wall(0.6f));
    const uint block = wall(0.7f);
    add_quad(scene, {-0.3f, -0.2f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}, block);  // top
    add_quad(scene, {-0.3f, -1, -0.3f}, {0, 0.8f, 0}, {0.6f, 0, 0}, block);
    add_quad(scene, {0.3f, -1, -0.3f}, {0, 0.8f, 0}, {0, 0, 0.6f}, block);
    add_quad(scene, {-0.3f, -1, 0.3f}, {0.6f, 0, 0}, {0, 0.8f, 0}, block);
    add_quad(scene, {-0.3f, -1, -0.3f}, {0, 0, 0.6f}, {0, 0.8f, 0}, block);
    return scene;
}

/// Points on the floor and the back wall, outside the block.
std::vector<Importon> points_in_room() {
    Pcg32 random(11);
    std::vector<Importon> points;
    for (uint i = 0; i < kPoints; ++i) {
        const float a = 1.9f * random.uniform() - 0.95f;
        const float b = 0.35f + 0.6f * random.uniform();
        const Vec3 normal = i % 2 == 0 ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
        const Vec3 position = i % 2 == 0 ? Vec3{a, -1, b} : Vec3{a, b, 1};
        points.push_back({.position = moved_off(position, normal, kExtent),
                          .pad0 = 0,
                          .normal = normal,
                          .flags = 2,
                          .response = {0.3f, 0.2f, 0.1f},
                          .pad1 = 0});
    }
    return points;
}

struct Reverse {
    std::vector<Vpl> vpls;
    std::vector<float> density;
};

Reverse trace_in_room(Device& device, const SceneOnDevice& scene, uint rays_per_point) {
    Gatherer gatherer(device);
    ReverseVpls stage(device, gatherer);
    const std::vector<Importon> importons = points_in_room();
    const CameraPoints points = make_camera_points(device, importons, rays_per_point);
    Reverse result;
    result.vpls = stage.trace(scene.buffers, points, 17);
    std::vector<ReceiverPoint> receivers;
    for (const Vpl& vpl : result.vpls) {
        receivers.push_back({vpl.position, vpl.normal});
    }
    const std::vector<ReceiverPacket> packets = test::pack_receivers(receivers);
    GatherSums<Importon> density(device, packets.size());
    stage.measure_density(scene.buffers, points, Buffer<ReceiverPacket>(device, std::span(packets)),
                          packets.size(), density);
    const std::vector<ImportancePacket> found = density.light.download();
    for (std::size_t i = 0; i < result.vpls.size(); ++i) {
        result.density.push_back(arrived_at(std::span(found), i).x);
    }
    return result;
}

/// The sum Σ_s m·cosθ_s·cosθ_y/(π d²)·V by a plain loop, with rays on the host.
double expected_density(const Bvh& bvh, const Vpl& y, uint rays_per_point) {
    double sum = 0;
    for (const Importon& s : points_in_room()) {
        const Vec3 between = y.position - s.position;
        const double squared = dot(between, between);
        const double cosines = double(dot(s.normal, between)) * -dot(y.normal, between);
        const bool facing = dot(s.normal, between) > 0 && dot(y.normal, between) < 0;
        if (facing && !occluded(bvh, s.position, between, 1e-5f, 1.0f - 1e-5f)) {
            sum += cosines / (squared * squared);
        }
    }
    return rays_per_point * sum / M_PI;
}

TEST_F(ReverseVplsTest, EachRayOfAClosedRoomLandsOnASurfaceAndTakesItsAlbedo) {
    on_each_device([](Device& device) {
        const SceneOnDevice scene(device, room_with_block());
        const Reverse found = trace_in_room(device, scene, 20);
        EXPECT_EQ(found.vpls.size(), kPoints * 20u);
        for (const Vpl& vpl : found.vpls) {
            const Vec3 p = vpl.position;
            const bool block = std::abs(p.x) < 0.31f && std::abs(p.z) < 0.31f && p.y < -0.19f;
            const float wall = vpl.normal.y > 0.5f    ? 0.1f
                               : vpl.normal.y < -0.5f ? 0.2f
                               : vpl.normal.z < -0.5f ? 0.3f
                               : vpl.normal.z > 0.5f  ? 0.4f
                               : vpl.normal.x > 0.5f  ? 0.5f
                                                      : 0.6f;
            ASSERT_EQ(vpl.power, (Vec3{block ? 0.7f : wall, 0.5f, 0.25f}));
            EXPECT_EQ(vpl.depth, 0u) << "carries light of all depths";
            EXPECT_EQ(vpl.flags, 0u);
            const float off = block ? std::min({std::abs(std::abs(p.x) - 0.3f),
                                                std::abs(std::abs(p.z) - 0.3f), std::abs(p.y + 0.2f)})
                                    : 1 - std::abs(dot(p, vpl.normal));
            EXPECT_GT(off, 0.0f);
            EXPECT_LT(off, 1e-5f);
        }
    });
}

TEST_F(ReverseVplsTest, DensityIsThatOfAPlainLoop) {
    on_each_device([](Device& device) {
        const SceneOnDevice scene(device, room_with_block());
        const Reverse found = trace_in_room(device, scene, 5);
        int different = 0;
        for (std::size_t i = 0; i < found.vpls.size(); ++i) {
            const double expected = expected_density(scene.bvh, found.vpls[i], 5);
            EXPECT_GT(found.density[i], 0.0f);
            different += std::abs(found.density[i] - expected) > 1e-3 * expected ? 1 : 0;
        }
        EXPECT_LE(different, 3) << "more than rays that meet an edge";
    });
}

/// Σ 1/n over the VPLs on a surface estimates its area.
TEST_F(ReverseVplsTest, InverseDensitiesAddUpToAreas) {
    on_each_device([](Device& device) {
        const SceneOnDevice scene(device, room_with_block());
        const Reverse found = trace_in_room(device, scene, 400);
        double ceiling = 0;
        double front = 0;
        for (std::size_t i = 0; i < found.vpls.size(); ++i) {
            ceiling += found.vpls[i].power.x == 0.2f ? 1 / found.density[i] : 0;
            const bool in_front = found.vpls[i].power.x == 0.4f && found.vpls[i].position.y > 0;
            front += in_front ? 1 / found.density[i] : 0;
        }
        EXPECT_NEAR(ceiling, 4.0, 0.12);
        EXPECT_NEAR(front, 2.0, 0.06);
    });
}

/// With a shading normal that leans, half of the rays leave below the surface of their own point.
TEST_F(ReverseVplsTest, APointMakesNoVplsOnItsOwnPlane) {
    on_each_device([](Device& device) {
        Scene floor;
        add_quad(floor, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0},
                 add_material(floor, lambertian({0.5f, 0.5f, 0.5f})));
        const SceneOnDevice scene(device, floor);
        const Importon leaning{
            .position = {0.1f, -1 + triangle_stand_off(floor, 0, bounds(floor).size()), 0.2f},
            .pad0 = 0,
            .normal = normalize({1, 0.2f, 0}),
            .flags = 2,
            .response = {1, 1, 1},
            .pad1 = 0};
        Gatherer gatherer(device);
        const CameraPoints points = make_camera_points(device, std::span(&leaning, 1), 200);
        EXPECT_TRUE(ReverseVpls(device, gatherer).trace(scene.buffers, points, 1).empty());
    });
}

TEST_F(ReverseVplsTest, NoPointsMakeNoVpls) {
    on_each_device([](Device& device) {
        const SceneOnDevice scene(device, room_with_block());
        Gatherer gatherer(device);
        EXPECT_TRUE(
            ReverseVpls(device, gatherer).trace(scene.buffers, make_camera_points(device, {}, 4), 1).empty());
    });
}

}  // namespace
}  // namespace nearlight::core
