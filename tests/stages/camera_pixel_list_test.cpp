// SPDX-License-Identifier: Apache-2.0
// The camera pass for a list of pixels.
#include <cstring>

#include "host/stages/camera_pass.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::GBuffer;
using test::kManyEdges;
using test::Shooting;

class CameraPixelListTest : public test::DeviceTest {};

/// A launch that looks at listed pixels finds for each of them what a launch over the picture finds.
TEST_F(CameraPixelListTest, ListedPixelsAreThoseOfThePicture) {
    Scene scene;
    const uint coat = add_material(scene, coated(scene, {0.5f, 0.5f, 0.5f}, {.alpha = 0.2}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 3}, {2, 0, 0}, coat);
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, add_material(scene, lambertian({0.8f, 0.7f, 0.6f})));
    set_camera(scene, {0.6, 0.3, -0.9}, {-0.1, -0.4, 1}, 60);
    set_constant_sky(scene, {1, 2, 3});
    on_each_ray_tree([&](Device& device) {
        constexpr uint kSamples = 3;
        Shooting shooting(device, scene, 37, 29);
        const GBuffer whole = shooting.shoot_all(kSamples, 2);
        // Between two entries that do not count, the list numbers the pixels of the part from (8, 16) on,
        // which is 20 pixels wide.
        std::vector<uint> listed{9999};
        for (uint i = 0; i < 71; ++i) {
            listed.push_back(i * 3 + 1);
        }
        listed.push_back(0);
        const Buffer<uint> numbers(device, listed);
        const ListedPixels only{numbers, {.count = 71, .first = 1, .width = 20, .x = 8, .y = 16}};
        const CameraBatch batch = one_tile_row({.sample_count = kSamples,
                                                .samples_per_pixel = kSamples,
                                                .branch_count = 2,
                                                .max_depth = kManyEdges});
        const GBuffer found = shooting.shoot(batch, 1, &only, 2 * NEARLIGHT_TILE_SIZE);
        const PacketOrder order = packet_order(batch, 2 * NEARLIGHT_TILE_SIZE);
        for (uint place = 0; place < 2 * NEARLIGHT_PACKET_SIZE; ++place) {
            const uint at_x = place % 16, at_y = place / 16;
            const uint lane = at_y * NEARLIGHT_TILE_SIZE + at_x % NEARLIGHT_TILE_SIZE;
            const uint pixel = place < 71 ? listed[place + 1] : 0;
            const uint x = 8 + pixel % 20, y = 16 + pixel / 20;
            const std::size_t same_lane =
                y % NEARLIGHT_TILE_SIZE * NEARLIGHT_TILE_SIZE + x % NEARLIGHT_TILE_SIZE;
            for (uint sample = 0; sample < kSamples; ++sample) {
                const CameraVertex& vertex =
                    found.vertices[packet_at(order, at_x / NEARLIGHT_TILE_SIZE, 0, sample, 0) *
                                       NEARLIGHT_PACKET_SIZE +
                                   lane];
                const std::size_t same = packet_at({5, kSamples, 2, 1, 1, 1, 1}, x / NEARLIGHT_TILE_SIZE,
                                                   y / NEARLIGHT_TILE_SIZE, sample, 0);
                if (place < 71) {
                    ASSERT_EQ(std::memcmp(&vertex, &whole.vertices[same * NEARLIGHT_PACKET_SIZE + same_lane],
                                          sizeof(CameraVertex)),
                              0)
                        << place;
                } else {
                    ASSERT_EQ(vertex.filter_weight, 0.0f) << "beyond the list";
                }
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
