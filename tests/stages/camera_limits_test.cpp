// SPDX-License-Identifier: Apache-2.0
// What camera paths count: the edges up to a light, the surfaces before a receiver, and samples.
#include "host/base/packed_direction.h"
#include "host/base/receivers.h"
#include "host/stages/camera_pass.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::GBuffer;
using test::Shooting;

class CameraLimitsTest : public test::DeviceTest {};

Material metal(float reflectance, float roughness) {
    Material metal = conductor_material({0, 0, 0}, {1, 1, 1}, Vec3{1, 1, 1} * reflectance);
    metal.roughness = parameter_of(roughness);
    return metal;
}

/// A mirror in front of the camera, which shows a wall at z = −1 that a point light shines at, above a floor.
Scene wall_in_mirror() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, add_material(scene, metal(0.1f, 0.0f)));
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, grey);
    add_quad(scene, {-1, -1, -1}, {0, 0, 3}, {2, 0, 0}, grey);
    add_point_light(scene, {0.5f, 0, 0}, {1, 4, 1});
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 0.001);
    return scene;
}

/// Rough metal in front of the camera, and a lamp behind a pane, behind the camera.
Scene lamp_over_metal(bool has_pane) {
    Scene scene;
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, add_material(scene, metal(0.8f, 0.3f)));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{3, 3, 3});
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lamp));
    if (has_pane) {
        add_quad(scene, {-2, -2, -0.5f}, {4, 0, 0}, {0, 4, 0},
                 add_material(scene, thin_dielectric_material(1.5)));
    }
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 0.001);
    return scene;
}

struct Seen {
    double emitted = 0;
    double traced = 0;
};

/// What 8×8 pixels see over paths of at most `max_depth` edges.
Seen seen_over(Shooting& shooting, uint max_depth, float min_weight = 0.0f) {
    Seen seen;
    for (const CameraVertex& v : shooting
                                     .shoot({.tile_row_count = 1,
                             .sample_count = 16,
                             .samples_per_pixel = 16,
                             .max_depth = max_depth,
                             .min_weight = min_weight})
                                     .vertices) {
        seen.emitted += v.camera_light.y + v.traced_direct.y;
        seen.traced += v.traced_indirect.y;
    }
    return seen;
}

TEST_F(CameraLimitsTest, TracedReceiversHaveTheEdgesThatAreLeft) {
    on_each_ray_tree([](Device& device) {
        Shooting shooting(device, wall_in_mirror(), 8, 8);
        constexpr float kAll = 2.0f;
        EXPECT_EQ(seen_over(shooting, 2, kAll).emitted, 0.0) << "to the mirror and the wall";
        const Seen direct = seen_over(shooting, 3, kAll);
        EXPECT_GT(direct.emitted, 0.0);
        EXPECT_EQ(direct.traced, 0.0) << "the floor is an edge farther";
        const Seen all = seen_over(shooting, 4, kAll);
        EXPECT_NEAR(all.emitted, direct.emitted, 1e-4 * direct.emitted) << "direct light stays apart";
        EXPECT_GT(all.traced, 0.01 * direct.emitted);
    });
}

/// Where rays bring light, a receiver in a mirror with at most two edges left asks no VPLs. It shows in the
/// layers of surfaces all the same.
TEST_F(CameraLimitsTest, ReceiversBehindMirrorsWithFewEdgesLeftAreTraced) {
    on_each_ray_tree([](Device& device) {
        Shooting shooting(device, wall_in_mirror(), 8, 8);
        for (const float min_weight : {0.0f, 1e-3f}) {
            for (uint max_depth = 2; max_depth < 8; ++max_depth) {
                const bool is_traced = min_weight > 0 && max_depth <= 4;
                const GBuffer found =
                    shooting.shoot({.tile_row_count = 1, .max_depth = max_depth, .min_weight = min_weight});
                double traced = 0;
                for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
                    EXPECT_EQ(is_zero(receiver_at(found.receivers, i).normal), is_traced) << max_depth;
                    const uint packed = found.receivers.front().mesh_normal[i];
                    EXPECT_EQ(packed != 0, is_traced) << max_depth;
                    EXPECT_TRUE(!is_traced || length(unpack_direction(packed) - Vec3{0, 0, 1}) < 1e-4f);
                    EXPECT_GT(found.vertices[i].throughput.y * found.vertices[i].albedo.y, 0.0f) << max_depth;
                    traced += found.vertices[i].traced_direct.y;
                }
                EXPECT_EQ(traced > 0, is_traced && max_depth > 2) << max_depth;
            }
        }
    });
}

TEST_F(CameraLimitsTest, LightSamplesOfGlossHaveTheEdgesThatAreLeft) {
    on_each_ray_tree([](Device& device) {
        Shooting open(device, lamp_over_metal(false), 8, 8);
        EXPECT_EQ(seen_over(open, 1).emitted, 0.0);
        const double seen = seen_over(open, 2).emitted;
        EXPECT_GT(seen, 0.0);
        Shooting glazed(device, lamp_over_metal(true), 8, 8);
        EXPECT_EQ(seen_over(glazed, 2).emitted, 0.0) << "the pane is an edge more";
        EXPECT_NEAR(seen_over(glazed, 3).emitted, 0.92 * seen, 0.1 * seen);
    });
}

TEST_F(CameraLimitsTest, ReceiversStandBeforeTheirSurfaceAndBehindOthers) {
    on_each_ray_tree([](Device& device) {
        const GBuffer found = Shooting(device, wall_in_mirror(), 8, 8).shoot_all(1, 1);
        for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            const ReceiverPoint receiver = receiver_at(found.receivers, i);
            EXPECT_GT(receiver.position.z, -1.0f);
            EXPECT_NEAR(receiver.position.z, -1.0f, 1e-3f);
            const uint surface = found.receivers.front().surface[i];
            EXPECT_EQ(surface >> NEARLIGHT_RECEIVER_SURFACES_SHIFT & NEARLIGHT_RECEIVER_SURFACES_MASK, 1u);
        }
    });
}

TEST_F(CameraLimitsTest, SoManySamplesShareASequenceOfRandomNumbers) {
    on_each_ray_tree([](Device& device) {
        Shooting shooting(device, wall_in_mirror(), 8, 8);
        const auto sequence_of = [&](uint sample) {
            return shooting
                .shoot({.tile_row_count = 1,
                        .first_sample = sample,
                        .samples_per_pixel = 2 * NEARLIGHT_SEQUENCE_RECEIVERS})
                .receivers.front()
                .sequence[0];
        };
        EXPECT_EQ(sequence_of(0), sequence_of(NEARLIGHT_SEQUENCE_RECEIVERS - 1));
        EXPECT_NE(sequence_of(0), sequence_of(NEARLIGHT_SEQUENCE_RECEIVERS));
    });
}

}  // namespace
}  // namespace nearlight::core
