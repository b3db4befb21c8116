// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_pass.h"

#include <cstring>

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/reference/bsdf/surface_bsdf.h"
#include "host/reference/camera_oracle.h"
#include "host/scene/camera.h"
#include "host/scene/material_model.h"
#include "host/scene/transmission_curve.h"
#include "tests/support/camera_shooting.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::GBuffer;
using test::kManyEdges;
using test::Shooting;

constexpr std::size_t kTile = NEARLIGHT_TILE_SIZE;

/// A floor, a wall and a box of two colours, open on one side and seen from a corner.
Scene open_room() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.8f, 0.7f, 0.6f}));
    const uint blue = add_two_sided(scene, lambertian({0.2f, 0.4f, 0.6f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 3}, {2, 0, 0}, white);
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, white);
    add_quad(scene, {-0.5f, -0.8f, 0.5f}, {0.8f, 0, 0.2f}, {0, 0.7f, 0}, blue);
    add_quad(scene, {0.2f, -0.9f, 0.2f}, {0, 0, 0.5f}, {0.1f, 0.6f, 0}, white);  // seen from behind: black
    set_camera(scene, {0.6, 0.3, -0.9}, {-0.1, -0.4, 1}, 60);
    return scene;
}

class CameraPassTest : public test::DeviceTest {};

TEST_F(CameraPassTest, PixelCentresFindWhatEmbreeFinds) {
    on_each_ray_tree([](Device& device) {
        const Scene scene = open_room();
        Shooting shooting(device, scene, 93, 61, 2.0f);
        const GBuffer found = shooting.shoot_all(1, 1);
        const CameraComparison comparison =
            compare_with_embree(scene, shooting.camera, shooting.region, found.receivers, found.vertices);
        EXPECT_EQ(comparison.mismatches, 0u);
        EXPECT_GT(comparison.receivers, 3000u);
        EXPECT_GT(comparison.absent, 500u);
        std::size_t close = 0;
        for (const CameraVertex& vertex : found.vertices) {
            close += vertex.flags & NEARLIGHT_VERTEX_CLOSE;
        }
        EXPECT_GT(close, 100u);
        EXPECT_LT(close, comparison.receivers - 100);
    });
}

/// If the camera looks along +Z with +Y up, +X is to the left.
TEST_F(CameraPassTest, LeftIsLeftAndUpIsUp) {
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{1, 0, 0});
    add_quad(scene, {0.5f, 0.5f, 2}, {0, 0.4f, 0}, {0.4f, 0, 0}, add_material(scene, lamp));
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 90);
    on_each_ray_tree([&](Device& device) {
        const GBuffer found = Shooting(device, scene, 16, 16).shoot_all(1, 1);
        // The lamp's middle (0.7, 0.7, 2) is 0.35 from the axis, so it is at pixel 8 − 0.35·8 = 5.2 from the
        // left and the top.
        for (std::size_t i = 0; i < found.vertices.size(); ++i) {
            const std::size_t tile = i / NEARLIGHT_PACKET_SIZE;
            const std::size_t x = tile % 2 * kTile + i % kTile;
            const std::size_t y = tile / 2 * kTile + i % NEARLIGHT_PACKET_SIZE / kTile;
            const bool on_lamp = x >= 4 && x <= 5 && y >= 4 && y <= 5;
            EXPECT_EQ(found.vertices[i].camera_light.x, on_lamp ? 1.0f : 0.0f) << x << ", " << y;
        }
    });
}

TEST_F(CameraPassTest, EmissionIsOfTheFrontOnly) {
    Scene scene;
    Material lamp = lambertian({0.5f, 0.5f, 0.5f});
    lamp.emission = parameter_of(Vec3{3, 2, 1});
    add_quad(scene, {-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, add_material(scene, lamp));
    on_each_ray_tree([&](Device& device) {
        set_camera(scene, {0, 0, 0}, {0, 0, 1}, 40);
        EXPECT_EQ(Shooting(device, scene, 8, 8).shoot_all(1, 1).vertices[9].camera_light.y, 2.0f);
        set_camera(scene, {0, 0, 4}, {0, 0, 1}, 40);
        EXPECT_EQ(Shooting(device, scene, 8, 8).shoot_all(1, 1).vertices[9].camera_light.y, 0.0f);
    });
}

/// Rows and samples may be divided in any way, and stored in any order.
TEST_F(CameraPassTest, BandsAndBatchesDoNotChangeABit) {
    Scene scene = open_room();
    scene.materials[0] = coated(scene, {0.5f, 0.5f, 0.5f}, {.alpha = 0.2});
    set_constant_sky(scene, {1, 2, 3});
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 37, 29);
        constexpr uint kSamples = 6;
        const GBuffer whole = shooting.shoot_all(kSamples, 2);
        const PacketOrder order{5, kSamples, 2, 1, 1, 1, 1};
        for (const auto& [row, rows, sample, samples, bundle_columns, bundle_rows, together] :
             {std::array<uint, 7>{0, 4, 0, 6, 1, 1, 1},
              {1, 2, 0, 6, 2, 1, 2},
              {3, 1, 2, 3, 1, 1, 3},
              {2, 2, 1, 4, 2, 2, 1},
              {0, 3, 5, 1, 2, 2, 1}}) {
            const CameraBatch batch{0,           row,      rows, sample,
                                    samples,     kSamples, 2,    bundle_columns,
                                    bundle_rows, together, 1,    kManyEdges};
            const GBuffer part = shooting.shoot(batch);
            for (uint i = 0; i < 5 * rows * samples * 2; ++i) {
                const uint x = i / 2 / samples % 5, y = i / 2 / samples / 5, s = i / 2 % samples;
                const uint p = packet_at(packet_order(batch, 37), x, y, s, i % 2);
                const uint same = packet_at(order, x, y + row, s + sample, i % 2);
                ASSERT_EQ(std::memcmp(&part.receivers[p], &whole.receivers[same], sizeof(ReceiverPacket)), 0);
                ASSERT_EQ(std::memcmp(&part.vertices[p * NEARLIGHT_PACKET_SIZE],
                                      &whole.vertices[same * NEARLIGHT_PACKET_SIZE],
                                      NEARLIGHT_PACKET_SIZE * sizeof(CameraVertex)),
                          0);
            }
        }
        EXPECT_NE(std::memcmp(shooting.shoot_all(kSamples, 2, 2).receivers.data(), whole.receivers.data(),
                              whole.receivers.size() * sizeof(ReceiverPacket)),
                  0);
    });
}

/// A receiver, its branch, and its vertex.
struct Branches {
    CameraVertex vertex[2];
    ReceiverPoint receiver[2];
};
Branches branches_of(const GBuffer& found, std::size_t tile_sample, std::size_t lane) {
    Branches result{};
    for (std::size_t branch = 0; branch < 2; ++branch) {
        const std::size_t index = (2 * tile_sample + branch) * NEARLIGHT_PACKET_SIZE + lane;
        result.vertex[branch] = found.vertices[index];
        result.receiver[branch] = receiver_at(found.receivers, index);
    }
    return result;
}

TEST_F(CameraPassTest, WithoutLobesTheSecondBranchIsAbsent) {
    Scene scene = open_room();
    set_constant_sky(scene, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        const GBuffer found = Shooting(device, scene, 32, 32).shoot_all(2, 2);
        std::size_t receivers = 0;
        for (std::size_t i = 0; i < found.vertices.size() / 2; ++i) {
            const Branches b = branches_of(found, i / NEARLIGHT_PACKET_SIZE, i % NEARLIGHT_PACKET_SIZE);
            receivers += is_zero(b.receiver[0].normal) ? 0 : 1;
            ASSERT_TRUE(is_zero(b.receiver[1].normal));
            ASSERT_TRUE(is_zero(b.vertex[1].throughput));
            ASSERT_TRUE(is_zero(b.vertex[1].camera_light));
        }
        EXPECT_GT(receivers, 500u);
    });
}

/// What of its base a smooth coat of index 1.5 with linear colours shows: T(cosθ) = 1 − F, between the values
/// of the curve, divided by (1 − i)·η², where i is the mean reflectance from inside.
float base_share(float cosine) {
    const TransmissionCurve curve = smooth_coat_curve(1.5);
    const float at = cosine * (NEARLIGHT_CURVE_SIZE - 1);
    const auto entry = static_cast<std::size_t>(at);
    const float transmitted = std::lerp(curve.at(entry), curve.at(entry + 1), at - std::floor(at));
    EXPECT_NEAR(transmitted, 1 - dielectric_reflectance(cosine, 1.5), 1e-5);
    return transmitted / static_cast<float>((1 - smooth_internal_reflectance(1.5)) * 1.5 * 1.5);
}

/// A smooth coat has two branches: its base, weighted by 1 − F in the albedo, and the mirror image, weighted
/// by F.
TEST_F(CameraPassTest, SmoothCoatDividesIntoBaseAndReflection) {
    Scene scene;
    const uint coat = add_material(scene, coated(scene, {0.5f, 0.4f, 0.3f}, {}));
    const uint wall = add_material(scene, lambertian({0.9f, 0.9f, 0.9f}));
    add_quad(scene, {-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, coat);
    add_quad(scene, {-9, 0, 3}, {0, 9, 0}, {18, 0, 0}, wall);
    set_camera(scene, {0, 1, 0}, {0, 0, 1.5}, 20);
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 24, 16);
        const GBuffer found = shooting.shoot_all(1, 2);
        for (std::size_t i = 0; i < found.vertices.size() / 2; ++i) {
            const std::size_t tile = i / NEARLIGHT_PACKET_SIZE;
            const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
            const Branches b = branches_of(found, tile, lane);
            const uint x = static_cast<uint>(tile % 3 * kTile + lane % kTile);
            const uint y = static_cast<uint>(tile / 3 * kTile + lane / kTile);
            const Vec3 d = pixel_ray(shooting.camera, x, y).direction;
            const auto f = static_cast<float>(dielectric_reflectance(-d.y, 1.5));
            const Vec3 base = scene.materials[coat].reflectance.value;
            ASSERT_NEAR(length(b.vertex[0].albedo - base * base_share(-d.y)), 0.0f, 1e-5f);
            ASSERT_EQ(b.vertex[0].throughput.x, 1.0f);
            ASSERT_NEAR(b.receiver[0].position.y, 0.0f, 1e-3f);
            ASSERT_NEAR(b.vertex[1].throughput.y, f, 1e-5f);
            ASSERT_NEAR(b.vertex[1].albedo.x, 0.9f, 1e-6f);
            ASSERT_NEAR(b.receiver[1].position.z, 3.0f, 1e-3f);
            // The mirror image is as if the ray had continued below the floor.
            ASSERT_NEAR(b.receiver[1].position.y, -(1.0f + d.y * 3.0f / d.z), 2e-3f);
        }
    });
}

/// Under a constant sky, glass that absorbs nothing looks like air. The emissions that both branches see add
/// up to the sky, whatever is behind the first surface, because later surfaces have weight 1. Bodies have
/// their fronts outside, and what the radiance loses where it enters it regains where it leaves.
TEST_F(CameraPassTest, ClearGlassUnderAConstantSkyIsInvisible) {
    for (const bool thin : {true, false}) {
        Scene scene;
        const uint glass =
            add_material(scene, thin ? thin_dielectric_material(1.5) : dielectric_material(1.5));
        constexpr Vec3 kUp{0.3f, 18, 0.2f};
        constexpr Vec3 kAside{18, 0, 0.1f};
        for (const float z : {1.0f, 2.0f}) {
            add_quad(scene, {-9, -9, z}, kUp, kAside, glass);
            add_quad(scene, {-9, -9, z + 0.5f}, kAside, kUp, glass);
        }
        set_constant_sky(scene, {1, 2, 3});
        set_camera(scene, {0, 0, 0}, {0.2, 0.1, 1}, 50);
        on_each_ray_tree([&](Device& device) {
            const GBuffer found = Shooting(device, scene, 16, 16).shoot_all(8, 2);
            for (std::size_t i = 0; i < found.vertices.size() / 2; ++i) {
                const Branches b = branches_of(found, i / NEARLIGHT_PACKET_SIZE, i % NEARLIGHT_PACKET_SIZE);
                ASSERT_NEAR(b.vertex[0].camera_light.y + b.vertex[1].camera_light.y, 2.0f, 2e-4f)
                    << "thin " << thin;
                ASSERT_GT(b.vertex[1].camera_light.y, 0.0f);
            }
        });
    }
}

/// Sums over all samples of what branches saw of lights.
double sum_emitted(const GBuffer& found) {
    double sum = 0;
    for (const CameraVertex& v : found.vertices) {
        sum += v.camera_light.y;
    }
    return sum;
}

/// Forty reflections between two walls, with chance ending some of the paths.
TEST_F(CameraPassTest, LongPathsBetweenMirrorsKeepTheirLight) {
    constexpr uint kReflections = 40;
    constexpr uint kSamples = 64;
    Scene scene;
    const uint mirror = add_two_sided(scene, conductor_material({0, 0, 0}, {1, 1, 1}, {0.99f, 0.99f, 0.99f}));
    for (const float x : {-1.0f, 1.0f}) {
        add_quad(scene, {x, -9, -1}, {0, 18, 0}, {0, 0, 2 * kReflections + 1}, mirror);
    }
    set_constant_sky(scene, {1, 2, 3});
    set_camera(scene, {0, 0, 0}, {1, 0, 1}, 0.001);
    const double radiance = 2 * std::pow(0.99, kReflections);
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 8, 8);
        const double sum = sum_emitted(shooting.shoot_all(kSamples, 1));
        EXPECT_NEAR(sum / (kSamples * 64), radiance, 0.1 * radiance);
        EXPECT_EQ(sum_emitted(shooting.shoot({.tile_row_count = 1, .max_depth = kReflections})), 0.0);
    });
}

/// One branch chosen at random must have the same expectation as two branches with their weights.
/// The sums over a picture of what was emitted and of the reflectance of receivers.
std::pair<double, double> picture_sums(Shooting& shooting, uint samples, uint branches) {
    double emitted = 0;
    double reflectance = 0;
    for (const CameraVertex& v : shooting.shoot_all(samples, branches).vertices) {
        emitted += v.camera_light.y;
        reflectance += static_cast<double>(v.throughput.y) * v.albedo.y;
    }
    return {emitted, reflectance};
}

/// Where a pane divides paths, coats behind it are left to chance with two branches too.
TEST_F(CameraPassTest, OneBranchAndTwoAgreeInMean) {
    for (const bool has_pane : {false, true}) {
        Scene scene = open_room();
        scene.materials[0] = coated(scene, {0.6f, 0.5f, 0.4f}, {.alpha = 0.1, .nonlinear = true});
        if (has_pane) {
            add_quad(scene, {-1, -1, -0.2f}, {0, 2, 0}, {2, 0, 0.3f},
                     add_material(scene, thin_dielectric_material(1.5)));
        }
        set_constant_sky(scene, {1, 1, 1});
        on_each_ray_tree([&](Device& device) {
            Shooting shooting(device, scene, 16, 16);
            const auto [emitted1, reflectance1] = picture_sums(shooting, 256, 1);
            const auto [emitted2, reflectance2] = picture_sums(shooting, 256, 2);
            EXPECT_NEAR(emitted1, emitted2, 0.01 * emitted2) << has_pane;
            EXPECT_NEAR(reflectance1, reflectance2, 0.01 * reflectance2) << has_pane;
            EXPECT_GT(emitted2, 0.05 * 256 * 256);
        });
    }
}

/// A mirror of reflectance 0.1 shows a wall behind the camera, which a point light shines at.
TEST_F(CameraPassTest, LightOfReceiversOfLittleWeightIsTraced) {
    Scene scene;
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0},
             add_material(scene, conductor_material({0, 0, 0}, {1, 1, 1}, {0.1f, 0.1f, 0.1f})));
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambertian({0.5f, 0.5f, 0.5f})));
    add_point_light(scene, {0.5f, 0, 0}, {1, 4, 1});
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 0.001);
    const float radiance = 0.5f / kPi * 4 / std::pow(1.25f, 1.5f);
    on_each_ray_tree([&](Device& device) {
        for (const float min_weight : {0.0f, 0.09f, 0.11f}) {
            const bool is_traced = min_weight > 0.1f;
            const GBuffer found = Shooting(device, scene, 8, 8)
                                      .shoot({.tile_row_count = 1, .max_depth = 5, .min_weight = min_weight});
            for (std::size_t i = 0; i < found.vertices.size(); ++i) {
                EXPECT_NEAR(found.vertices[i].traced_direct.y, is_traced ? 0.1f * radiance : 0.0f, 1e-5f);
                EXPECT_TRUE(is_zero(found.vertices[i].camera_light));
                EXPECT_EQ(is_zero(receiver_at(found.receivers, i).normal), is_traced);
                EXPECT_TRUE(is_zero(found.vertices[i].traced_indirect))
                    << "there is no second surface to reflect";
            }
        }
    });
}

struct Scattered {
    double up = 0;
    double down = 0;
};

/// Mean radiance that a rough interface with the normal y reflects from an upper and lets through from a
/// lower hemisphere of radiance 1, by the reference's BSDF.
Scattered scattered(const Scene& scene, Vec3 to_viewer, int samples) {
    const Surface surface{.position = {0, 0, 0},
                          .geometric_normal = {0, 1, 0},
                          .front_normal = {0, 1, 0},
                          .along_u = {0, 0, 0},
                          .along_v = {0, 0, 0},
                          .material = scene.materials.data()};
    const SurfaceBsdf bsdf(scene, surface, as_double(to_viewer), 0.5);
    Scattered sums;
    for (int i = 0; i < samples; ++i) {
        const SurfaceDraw draw = bsdf.sample_specular(even_random(i));
        (draw.wi.y > 0 ? sums.up : sums.down) += draw.weight.x / samples;
    }
    return sums;
}

/// One rough interface under half a sky: the branches together see what the reference's BSDF reflects of the
/// upper half, or lets through of the lower half.
TEST_F(CameraPassTest, RoughGlassMasksBothWays) {
    for (const float roughness : {0.3f, 0.7f}) {
        for (const double tilt : {10.0, 65.0}) {
            Scene scene;
            Material glass = dielectric_material(1.5);
            glass.roughness = parameter_of(roughness);
            add_quad(scene, {-90, 0, -90}, {0, 0, 180}, {180, 0, 0}, add_material(scene, glass));
            const double angle = tilt * kPi / 180;
            const Vec3 to_viewer{static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0};
            set_camera(scene, {to_viewer.x, to_viewer.y, to_viewer.z}, {0, 0, 0}, 0.01, {0, 0, 1});
            const Scattered expected = scattered(scene, to_viewer, 200'000);
            for (const bool above : {true, false}) {
                const Vec3 white{1, 1, 1};
                const Vec3 black{0, 0, 0};
                scene.environment = {.width = 1,
                                     .height = 2,
                                     .radiance = {above ? white : black, above ? black : white},
                                     .to_world = {}};
                on_each_ray_tree([&](Device& device) {
                    double sum = 0;
                    for (const CameraVertex& vertex :
                         Shooting(device, scene, 8, 8).shoot_all(2048, 2).vertices) {
                        sum += vertex.camera_light.x;
                    }
                    EXPECT_NEAR(sum / (64.0 * 2048), above ? expected.up : expected.down, 0.004)
                        << roughness << ", " << tilt << "°, above " << above;
                });
            }
        }
    }
}

}  // namespace
}  // namespace nearlight::core
