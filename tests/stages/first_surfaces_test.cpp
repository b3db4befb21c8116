// SPDX-License-Identifier: Apache-2.0
#include "host/stages/first_surfaces.h"

#include <algorithm>

#include "host/reference/brute_force.h"
#include "host/scene/camera.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr uint kColumns = 37;
constexpr uint kRows = 29;
constexpr uint kSeed = 1;

/// A floor, a wall and two boards, one of which is a mirror, open on one side.
Scene boards() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    const uint mirror = add_material(scene, conductor_material({0, 0, 0}, {1, 1, 1}, {1, 1, 1}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 3}, {2, 0, 0}, grey);
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, grey);
    add_quad(scene, {-0.5f, -0.8f, 0.5f}, {0.8f, 0, 0.2f}, {0, 0.7f, 0}, mirror);
    add_quad(scene, {0.2f, -0.9f, 0.2f}, {0, 0, 0.5f}, {0.1f, 0.6f, 0}, grey);
    set_camera(scene, {0.6, 0.3, -0.9}, {-0.1, -0.4, 1}, 60);
    return scene;
}

std::vector<uint> see(Device& device, const Scene& scene, const SampleBlock& block, uint seed = kSeed) {
    const test::SceneOnDevice on_device(device, scene);
    const Camera camera = make_camera(scene.camera, kColumns, kRows);
    const Buffer<Camera> cameras(device, std::span(&camera, 1));
    Buffer<uint> triangles(device, block.size());
    FirstSurfaces(device).run(on_device.buffers, cameras, block, seed, triangles);
    return triangles.download();
}

SampleBlock whole_picture(uint samples) {
    return {.width = kColumns, .row_count = kRows, .sample_count = samples, .in_middle = samples == 1};
}

class FirstSurfacesTest : public test::DeviceTest {};

TEST_F(FirstSurfacesTest, PixelCentresSeeWhatBruteForceSees) {
    const Scene scene = boards();
    const Camera camera = make_camera(scene.camera, kColumns, kRows);
    on_each_ray_tree([&](Device& device) {
        const std::vector<uint> found = see(device, scene, whole_picture(1));
        std::vector<std::size_t> seen(scene.triangles.size());
        for (uint i = 0; i < found.size(); ++i) {
            const Vec3 direction =
                normalize(camera.corner + camera.step_x * (static_cast<float>(i % kColumns) + 0.5f) +
                          camera.step_y * (static_cast<float>(i / kColumns) + 0.5f));
            const BvhHit hit = brute_force_closest_hit(scene, {}, camera.origin, direction, 0.0f, 1e9f);
            EXPECT_EQ(found[i], hit.triangle) << i % kColumns << ", " << i / kColumns;
            if (found[i] != ~0u) {
                ++seen.at(found[i]);
            }
        }
        EXPECT_EQ(std::ranges::count(seen, 0u), 0) << "all triangles are seen";
        EXPECT_GT(std::ranges::count(found, ~0u), 10);
    });
}

/// The plane of the first triangle is where the camera pass finds its receiver, and its distance, with the
/// same random numbers.
TEST_F(FirstSurfacesTest, SamplesAreThoseOfTheCameraPass) {
    Scene scene = boards();
    scene.camera.filter = default_filter(FilterKind::mitchell);
    scene.camera.aperture_radius = 0.05;
    constexpr uint kSamples = 6;
    on_each_ray_tree([&](Device& device) {
        const std::vector<uint> found = see(device, scene, whole_picture(kSamples));
        test::Shooting shooting(device, scene, kColumns, kRows);
        const test::GBuffer buffer = shooting.shoot_all(kSamples, 1, kSeed);
        const PacketOrder order{tiles_across(kColumns), kSamples, 1, 1, 1, 1, 1};
        uint compared = 0;
        for (uint i = 0; i < found.size(); ++i) {
            const uint pixel = i / kSamples, x = pixel % kColumns, y = pixel / kColumns;
            const uint packet =
                packet_at(order, x / NEARLIGHT_TILE_SIZE, y / NEARLIGHT_TILE_SIZE, i % kSamples, 0);
            const uint lane = y % NEARLIGHT_TILE_SIZE * NEARLIGHT_TILE_SIZE + x % NEARLIGHT_TILE_SIZE;
            const CameraVertex& vertex = buffer.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
            ASSERT_EQ(found[i] != ~0u, vertex.depth > 0.0f) << x << ", " << y;
            if (found[i] == ~0u || scene.triangles[found[i]].material != 0) {
                continue;  // the receiver of a mirror lies elsewhere
            }
            const Triangle& t = scene.triangles[found[i]];
            const Vec3 a = scene.vertices[t.v0].position;
            const Vec3 normal =
                normalize(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a));
            const ReceiverPacket& receiver = buffer.receivers[packet];
            if (receiver.nx[lane] == 0.0f && receiver.ny[lane] == 0.0f && receiver.nz[lane] == 0.0f) {
                continue;  // the back of a board is black
            }
            const Vec3 at{receiver.px[lane], receiver.py[lane], receiver.pz[lane]};
            EXPECT_LT(std::abs(dot(at - a, normal)), 1e-3f) << x << ", " << y;
            ++compared;
        }
        EXPECT_GT(compared, found.size() / 3);
    });
}

TEST_F(FirstSurfacesTest, WindowsAndBlocksOfSamplesDoNotChangeABit) {
    const Scene scene = boards();
    constexpr uint kSamples = 5;
    on_each_ray_tree([&](Device& device) {
        const std::vector<uint> whole = see(device, scene, whole_picture(kSamples));
        const SampleBlock block{.first_column = 11,
                                .first_row = 7,
                                .width = 9,
                                .row_count = 13,
                                .first_sample = 2,
                                .sample_count = 3};
        const std::vector<uint> part = see(device, scene, block);
        ASSERT_EQ(part.size(), block.size());
        for (uint i = 0; i < part.size(); ++i) {
            const uint pixel = i / 3, x = 11 + pixel % 9, y = 7 + pixel / 9;
            ASSERT_EQ(part[i], whole[(y * kColumns + x) * kSamples + 2 + i % 3]) << x << ", " << y;
        }
    });
}

/// A mask of opacity 0.3 over all of the picture, before a wall: each sample sees one of them.
TEST_F(FirstSurfacesTest, HolesOfMasksLetSamplesThrough) {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    const uint mask = add_material(scene, mask_material(parameter_of(0.3f), grey));
    const uint none = add_material(scene, plain_material(NEARLIGHT_BSDF_NULL));
    add_quad(scene, {-9, -9, 4}, {0, 18, 0}, {18, 0, 0}, grey);
    add_quad(scene, {-9, -9, 3}, {0, 18, 0}, {18, 0, 0}, mask);
    add_quad(scene, {-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, none);
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 60);
    on_each_ray_tree([&](Device& device) {
        const std::vector<uint> found = see(device, scene, whole_picture(4));
        const auto of_mask = [](uint triangle) { return triangle == 2 || triangle == 3; };
        const auto of_wall = [](uint triangle) { return triangle == 0 || triangle == 1; };
        const double share =
            static_cast<double>(std::ranges::count_if(found, of_mask)) / static_cast<double>(found.size());
        EXPECT_NEAR(share, 0.3, 0.035);  // five standard deviations of 4292 samples
        EXPECT_EQ(std::ranges::count_if(found, of_mask) + std::ranges::count_if(found, of_wall),
                  static_cast<long>(found.size()));
        // Of each sixteenth of the numbers from 0 to 1, a pixel has one.
        const std::vector<uint> sixteen = see(device, scene, whole_picture(16));
        for (auto pixel = sixteen.begin(); pixel != sixteen.end(); pixel += 16) {
            const auto seen = std::count_if(pixel, pixel + 16, of_mask);
            ASSERT_TRUE(seen == 4 || seen == 5) << seen << " of 16 is not about 0.3";
        }
    });
}

/// A mask like a chessboard, whose light is `emission`, before a wall; its front or its back is seen.
Scene shining_mask(const Parameter& opacity, const Parameter& emission, bool is_front) {
    Scene scene;
    add_checkerboard(scene, 1, parameter_of(1.0f), parameter_of(0.0f));
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    Material mask = mask_material(opacity, grey);
    mask.emission = emission;
    const Vec3 up{0, 18, 0}, across{18, 0, 0};
    add_quad(scene, {-9, -9, 4}, up, across, grey);
    add_quad(scene, {-9, -9, 3}, is_front ? up : across, is_front ? across : up, add_material(scene, mask));
    for (Vertex& vertex : scene.vertices) {
        vertex.u = vertex.position.x;
        vertex.v = vertex.position.y;
    }
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 60);
    return scene;
}

TEST_F(FirstSurfacesTest, MasksAreSeenInTheirHolesOnlyWhereTheyShine) {
    const Parameter dark = parameter_of(0.0f), light = parameter_of(2.0f);
    const Parameter half = parameter_of(0.5f), chequered = textured(0);
    on_each_ray_tree([&](Device& device) {
        const auto seen = [&](const Parameter& opacity, const Parameter& emission, bool is_front) {
            return see(device, shining_mask(opacity, emission, is_front), whole_picture(4));
        };
        const std::vector<uint> holes = seen(chequered, dark, true);
        EXPECT_GT(std::ranges::count_if(holes, [](uint triangle) { return triangle < 2; }), 100);
        EXPECT_GT(std::ranges::count_if(holes, [](uint triangle) { return triangle >= 2; }), 100);
        EXPECT_EQ(seen(chequered, chequered, true), holes) << "the holes do not shine";
        EXPECT_EQ(seen(half, light, false), seen(half, dark, false)) << "only the front shines";
        EXPECT_EQ(std::ranges::count_if(seen(half, light, true), [](uint triangle) { return triangle < 2; }),
                  0);
    });
}

TEST_F(FirstSurfacesTest, EmittersAreSeenUnlessTheyAreHidden) {
    Scene scene = boards();
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{1, 1, 1});
    const auto lamp_triangle = static_cast<uint>(scene.triangles.size());
    add_quad(scene, {0.2f, -0.2f, -0.4f}, {0, 0.4f, 0}, {0.4f, 0, 0}, add_material(scene, lamp));
    on_each_ray_tree([&](Device& device) {
        scene.camera.hide_emitters = false;
        EXPECT_GT(std::ranges::count(see(device, scene, whole_picture(1)), lamp_triangle), 5);
        scene.camera.hide_emitters = true;
        EXPECT_EQ(see(device, scene, whole_picture(1)), see(device, boards(), whole_picture(1)));
    });
}

}  // namespace
}  // namespace nearlight::core
