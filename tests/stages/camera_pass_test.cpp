// SPDX-License-Identifier: Apache-2.0
#include "host/stages/camera_pass.h"

#include <cstring>

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/reference/camera_oracle.h"
#include "host/reference/lobe.h"
#include "host/scene/camera.h"
#include "host/scene/material_model.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

constexpr std::size_t kTile = NEARLIGHT_TILE_SIZE;

struct GBuffer {
    std::vector<ReceiverPacket> receivers;
    std::vector<CameraVertex> vertices;
};

/// A camera pass over one scene and view.
class Shooting {
  public:
    Shooting(Device& device, const Scene& scene, int width, int height, float range = 1.0f)
        : camera(make_camera(scene.camera, width, height)),
          region(make_close_range(camera, range)),
          device_(&device),
          pass_(device),
          scene_(device, scene),
          cameras_(device, std::span(&camera, 1)),
          regions_(device, std::span(&region, 1)) {}

    GBuffer shoot(const CameraBand& band, uint seed = 1) {
        const std::size_t packets = packet_count(band, camera.width);
        Buffer<ReceiverPacket> receivers(*device_, packets);
        Buffer<CameraVertex> vertices(*device_, packets * NEARLIGHT_PACKET_SIZE);
        pass_.run(scene_.buffers, cameras_, camera.width, regions_, band, seed, receivers, vertices);
        return {receivers.download(), vertices.download()};
    }
    /// Renders all rows, with all `samples` samples.
    GBuffer shoot_all(uint samples, uint branches, uint seed = 1) {
        return shoot({.tile_row_count = tiles_across(camera.height),
                      .sample_count = samples,
                      .samples_per_pixel = samples,
                      .branch_count = branches},
                     seed);
    }

    Camera camera;
    CloseRange region;

  private:
    Device* device_;
    CameraPass pass_;
    SceneOnDevice scene_;
    Buffer<Camera> cameras_;
    Buffer<CloseRange> regions_;
};

void set_constant_sky(Scene& scene, Vec3 radiance) {
    scene.environment = {.width = 1, .height = 1, .radiance = {radiance}, .to_world = {}};
}

/// A floor, a wall and a box of two colours, open on one side and seen from a corner.
Scene open_room() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.8f, 0.7f, 0.6f}));
    Material two_sided = lambertian({0.2f, 0.4f, 0.6f});
    two_sided.flags = NEARLIGHT_MATERIAL_TWO_SIDED;
    const uint blue = add_material(scene, two_sided);
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
    lamp.emission = {1, 0, 0};
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
            EXPECT_EQ(found.vertices[i].emitted.x, on_lamp ? 1.0f : 0.0f) << x << ", " << y;
        }
    });
}

TEST_F(CameraPassTest, EmissionIsOfTheFrontOnly) {
    Scene scene;
    Material lamp = lambertian({0.5f, 0.5f, 0.5f});
    lamp.emission = {3, 2, 1};
    add_quad(scene, {-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, add_material(scene, lamp));
    on_each_ray_tree([&](Device& device) {
        set_camera(scene, {0, 0, 0}, {0, 0, 1}, 40);
        EXPECT_EQ(Shooting(device, scene, 8, 8).shoot_all(1, 1).vertices[9].emitted.y, 2.0f);
        set_camera(scene, {0, 0, 4}, {0, 0, 1}, 40);
        EXPECT_EQ(Shooting(device, scene, 8, 8).shoot_all(1, 1).vertices[9].emitted.y, 0.0f);
    });
}

/// Rows and samples may be divided in any way.
TEST_F(CameraPassTest, BandsAndBatchesDoNotChangeABit) {
    Scene scene = open_room();
    scene.materials[0] = coat_material({0.5f, 0.5f, 0.5f}, {1, 1, 1}, 1.5, 0.2f, false);
    set_constant_sky(scene, {1, 2, 3});
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 37, 29);
        constexpr uint kSamples = 6;
        const uint tiles_x = 5;
        const GBuffer whole = shooting.shoot_all(kSamples, 2);
        for (const auto& [first_row, rows, first_sample, samples] :
             {std::array<uint, 4>{0, 4, 0, 6}, {1, 2, 0, 6}, {3, 1, 2, 3}, {0, 4, 5, 1}}) {
            const GBuffer part = shooting.shoot({.first_tile_row = first_row,
                                                 .tile_row_count = rows,
                                                 .first_sample = first_sample,
                                                 .sample_count = samples,
                                                 .samples_per_pixel = kSamples,
                                                 .branch_count = 2});
            for (std::size_t p = 0; p < part.receivers.size(); ++p) {
                const std::size_t tile = p / (2 * samples) + first_row * tiles_x;
                const std::size_t sample = p / 2 % samples + first_sample;
                const std::size_t same = (tile * kSamples + sample) * 2 + p % 2;
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
            ASSERT_TRUE(is_zero(b.vertex[1].emitted));
        }
        EXPECT_GT(receivers, 500u);
    });
}

/// A smooth coat has two branches: its base, weighted by 1 − F in the albedo, and the mirror image, weighted
/// by F.
TEST_F(CameraPassTest, SmoothCoatDividesIntoBaseAndReflection) {
    Scene scene;
    const uint coat = add_material(scene, coat_material({0.5f, 0.4f, 0.3f}, {1, 1, 1}, 1.5, 0.0f, false));
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
            const Vec3 base = camera_albedo(scene, scene.materials[coat], 0, 0);
            ASSERT_NEAR(length(b.vertex[0].albedo - base * (1.0f - f)), 0.0f, 1e-5f);
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
/// up to the sky, whatever is behind the first surface, because later surfaces have weight 1.
TEST_F(CameraPassTest, ClearGlassUnderAConstantSkyIsInvisible) {
    for (const bool thin : {true, false}) {
        Scene scene;
        const uint glass = add_material(scene, glass_material(1.5, thin));
        for (const float z : {1.0f, 1.5f, 2.0f, 2.5f}) {
            add_quad(scene, {-9, -9, z}, {0.3f, 18, 0.2f}, {18, 0, 0.1f}, glass);
        }
        set_constant_sky(scene, {1, 2, 3});
        set_camera(scene, {0, 0, 0}, {0.2, 0.1, 1}, 50);
        on_each_ray_tree([&](Device& device) {
            const GBuffer found = Shooting(device, scene, 16, 16).shoot_all(8, 2);
            for (std::size_t i = 0; i < found.vertices.size() / 2; ++i) {
                const Branches b = branches_of(found, i / NEARLIGHT_PACKET_SIZE, i % NEARLIGHT_PACKET_SIZE);
                ASSERT_NEAR(b.vertex[0].emitted.y + b.vertex[1].emitted.y, 2.0f, 2e-4f) << "thin " << thin;
                ASSERT_GT(b.vertex[1].emitted.y, 0.0f);
            }
        });
    }
}

/// One branch chosen at random must have the same expectation as two branches with their weights.
TEST_F(CameraPassTest, OneBranchAndTwoAgreeInMean) {
    Scene scene = open_room();
    scene.materials[0] = coat_material({0.6f, 0.5f, 0.4f}, {1, 1, 1}, 1.5, 0.1f, true);
    add_quad(scene, {-1, -1, -0.2f}, {0, 2, 0}, {2, 0, 0.3f}, add_material(scene, glass_material(1.5, true)));
    set_constant_sky(scene, {1, 1, 1});
    on_each_ray_tree([&](Device& device) {
        Shooting shooting(device, scene, 16, 16);
        const auto mean = [&](uint branches) {
            double emitted = 0;
            double reflectance = 0;
            for (const CameraVertex& v : shooting.shoot_all(256, branches).vertices) {
                emitted += v.emitted.y;
                reflectance += static_cast<double>(v.throughput.y) * v.albedo.y;
            }
            return std::pair{emitted / (256 * 256), reflectance / (256 * 256)};
        };
        const auto [emitted1, reflectance1] = mean(1);
        const auto [emitted2, reflectance2] = mean(2);
        EXPECT_NEAR(emitted1, emitted2, 0.01 * emitted2);
        EXPECT_NEAR(reflectance1, reflectance2, 0.01 * reflectance2);
        EXPECT_GT(emitted2, 0.05);
    });
}

struct LobeWeights {
    double reflected = 0;
    double transmitted = 0;
};

/// Mean weights of the light that a rough interface reflects and transmits, by the reference's lobes.
LobeWeights lobe_weights(const Material& material, Vec3 to_viewer, int samples) {
    const Surface surface{.position = {0, 0, 0},
                          .geometric_normal = {0, 0, 1},
                          .shading_normal = {0, 0, 1},
                          .material = &material};
    Pcg32 random(31);
    LobeWeights sums;
    for (int i = 0; i < samples; ++i) {
        const LobeRandom u{random.uniform(), {random.uniform(), random.uniform()}};
        const LobeSample sample = sample_lobe(surface, to_viewer, u);
        (sample.direction.z > 0 ? sums.reflected : sums.transmitted) += sample.weight.x;
    }
    return {sums.reflected / samples, sums.transmitted / samples};
}

/// One rough interface under a constant sky: each branch sees what the reference's lobes transmit and
/// reflect.
TEST_F(CameraPassTest, RoughGlassMasksBothWays) {
    Material glass = glass_material(1.5, false);
    for (const float roughness : {0.3f, 0.7f}) {
        for (const double tilt : {10.0, 65.0}) {
            glass.roughness = roughness;
            Scene scene;
            add_quad(scene, {-90, -90, 0}, {180, 0, 0}, {0, 180, 0}, add_material(scene, glass));
            set_constant_sky(scene, {1, 1, 1});
            const double angle = tilt * kPi / 180;
            const Vec3 to_viewer{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
            set_camera(scene, {to_viewer.x, to_viewer.y, to_viewer.z}, {0, 0, 0}, 0.01);
            const LobeWeights weights = lobe_weights(glass, to_viewer, 200'000);
            on_each_ray_tree([&](Device& device) {
                const GBuffer found = Shooting(device, scene, 8, 8).shoot_all(2048, 2);
                double sums[2] = {0, 0};
                for (std::size_t i = 0; i < found.vertices.size(); ++i) {
                    sums[i / NEARLIGHT_PACKET_SIZE % 2] += found.vertices[i].emitted.x;
                }
                const double count = 64.0 * 2048;
                EXPECT_NEAR(sums[0] / count, weights.transmitted, 0.004) << roughness << ", " << tilt << "°";
                EXPECT_NEAR(sums[1] / count, weights.reflected, 0.004) << roughness << ", " << tilt << "°";
            });
        }
    }
}

}  // namespace
}  // namespace nearlight::core
