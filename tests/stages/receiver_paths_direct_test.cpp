// SPDX-License-Identifier: Apache-2.0
// Direct light, by light samples and by rays that meet lights.
#include "host/stages/receiver_paths.h"

#include <cmath>
#include <cstring>

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/reference/light_sampler.h"
#include "host/reference/reference_gather.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

/// Of each receiver.
struct Samples {
    uint light = 1;
    uint rays = 0;
};
/// Multiple importance sampling must not change the mean, however many rays there are for a light sample.
constexpr Samples kManySamples[] = {{1024, 0}, {1024, 1024}, {256, 1024}, {2048, 512}};

class ReceiverPathsDirectTest : public test::DeviceTest {
  protected:
    template <typename Check>
    void on_each_sample_count(const Check& check) {
        on_each_ray_tree([&](Device& device) {
            for (const Samples& samples : kManySamples) {
                SCOPED_TRACE(std::to_string(samples.light) + " samples, " + std::to_string(samples.rays) +
                             " rays");
                check(device, samples);
            }
        });
    }
};

std::vector<IrradiancePacket> illuminate(Device& device, const Scene& scene,
                                         const std::vector<ReceiverPacket>& receivers, const Samples& samples,
                                         uint seed = 1) {
    const SceneOnDevice on_device(device, scene);
    const Buffer<ReceiverPacket> input(device, receivers);
    Buffer<IrradiancePacket> direct(device, receivers.size());
    Buffer<IrradiancePacket> indirect(device, receivers.size());
    ReceiverPaths(device).run({on_device.buffers,
                               input,
                               receivers.size(),
                               {.light_samples = samples.light, .rays = samples.rays, .seed = seed}},
                              direct, indirect);
    for (const IrradiancePacket& packet : indirect.download()) {
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            EXPECT_TRUE(is_zero(irradiance_at(std::span(&packet, 1), lane))) << "paths have one edge";
        }
    }
    return direct.download();
}

Vec3 random_vector(Pcg32& random) {
    const float x = 2.0f * random.uniform() - 1.0f;
    const float y = 2.0f * random.uniform() - 1.0f;
    return {x, y, 2.0f * random.uniform() - 1.0f};
}

/// Receivers anywhere in [−1, 1]³ that face anywhere; every seventh is absent.
std::vector<ReceiverPacket> random_receivers(std::size_t count) {
    Pcg32 random(3);
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 position = random_vector(random);
        const Vec3 normal = normalize(random_vector(random));
        points.push_back({position, i % 7 == 6 ? Vec3{0, 0, 0} : normal});
    }
    return test::pack_receivers(points);
}

/// Small squares that cast shadows.
Scene scattered_squares() {
    Scene scene;
    const uint material = add_material(scene, lambertian({0.5f, 0.5f, 0.5f}));
    Pcg32 random(4);
    for (int i = 0; i < 40; ++i) {
        const Vec3 corner = random_vector(random);
        const Vec3 side = random_vector(random) * 0.4f;
        add_quad(scene, corner, side, random_vector(random) * 0.4f, material);
    }
    return scene;
}

void add_spot(Scene& scene, Vec3 position, Vec3 axis, float beam, float cutoff) {
    add_point_light(scene, position, {2, 3, 4});
    Emitter& spot = scene.delta_emitters.back();
    spot.type = NEARLIGHT_EMITTER_SPOT;
    spot.direction = normalize(axis);
    spot.beam_angle = degrees_to_radians(beam);
    spot.cutoff_angle = degrees_to_radians(cutoff);
}

/// With sixteen delta lights, all are used, so the result is exact except at shadow edges.
TEST_F(ReceiverPathsDirectTest, SixteenDeltaLightsAgreeWithEmbree) {
    Scene scene = scattered_squares();
    const int bitmap = add_small_bitmap(scene);
    Pcg32 random(5);
    for (int i = 0; i < 16; ++i) {
        const Vec3 position = random_vector(random);
        const Vec3 direction = random_vector(random);
        if (i % 4 == 0) {
            add_point_light(scene, position, {1, 2, 0.5f});
        } else if (i % 4 == 1) {
            add_spot(scene, position, direction, 20, 50);
            Emitter& spot = scene.delta_emitters.back();
            const auto [x, y] = orthonormal_basis(spot.direction);
            spot.x_axis = x * 0.4f;
            spot.y_axis = y * 0.4f;
            spot.image = i % 8 == 1 ? static_cast<uint>(bitmap + 1) : 0;
        } else if (i % 4 == 2) {
            add_projector(scene, position, direction, 0.7f, 0.4f, {1, 3, 2}, i % 8 == 2 ? bitmap : -1);
        } else {
            add_directional_light(scene, direction, {0.3f, 0.2f, 0.1f});
        }
    }
    const std::vector<ReceiverPacket> receivers = random_receivers(2000);
    std::vector<IrradiancePacket> expected(receivers.size());
    direct_reference(EmbreeScene(scene), scene, receivers, expected, 1);
    on_each_ray_tree([&](Device& device) {
        // Rays cannot meet these lights.
        const std::vector<IrradiancePacket> found = illuminate(device, scene, receivers, {1, 2});
        std::size_t lit = 0;
        std::size_t different = 0;
        for (std::size_t i = 0; i < receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
            const Vec3 e = irradiance_at(expected, i);
            lit += e.x > 0 ? 1 : 0;
            different += length(irradiance_at(found, i) - e) > 2e-4f * (0.1f + length(e)) ? 1 : 0;
        }
        EXPECT_GT(lit, 1000u);
        EXPECT_LE(different, 2u) << "more than rays that meet an edge";
    });
}

TEST_F(ReceiverPathsDirectTest, PointLightFollowsTheFormula) {
    Scene scene;
    add_triangle(scene, {90, 90, 90}, {91, 90, 90}, {90, 91, 90}, add_material(scene, lambertian({1, 1, 1})));
    add_point_light(scene, {1, 2, 0}, {8, 4, 2});
    on_each_ray_tree([&](Device& device) {
        const auto e = illuminate(device, scene,
                                  test::pack_receivers({{{1, 0, 0}, {0, 1, 0}},
                                                        {{1, 0, 2}, {0, 1, 0}},
                                                        {{1, 0, 0}, {0, -1, 0}},
                                                        {{1, 0, 0}, {0, 0, 0}}}),
                                  {1, 0});
        EXPECT_NEAR(irradiance_at(e, 0).x, 2.0f, 1e-5f);                           // 8 / 2²
        EXPECT_NEAR(irradiance_at(e, 1).y, 4.0f / 8.0f * std::sqrt(0.5f), 1e-5f);  // 45°, r² = 8
        EXPECT_TRUE(is_zero(irradiance_at(e, 2)) && is_zero(irradiance_at(e, 3)));
    });
}

/// A plane across the axis of a projector is evenly lit inside its image, and not at all outside.
TEST_F(ReceiverPathsDirectTest, ProjectorLightsAPlaneEvenly) {
    Scene scene;
    add_triangle(scene, {90, 90, 90}, {91, 90, 90}, {90, 91, 90}, add_material(scene, lambertian({1, 1, 1})));
    add_projector(scene, {0, 0, 2}, {0, 0, -1}, 1.0f, 0.5f, {8, 4, 2}, -1);
    const Vec3 x = normalize(scene.delta_emitters[0].x_axis);
    const Vec3 y = normalize(scene.delta_emitters[0].y_axis);
    std::vector<ReceiverPoint> points;
    for (const auto& [s, t] :
         {std::pair{0.0f, 0.0f}, {1.9f, 0.9f}, {-1.9f, -0.9f}, {2.1f, 0.0f}, {0.0f, 1.1f}}) {
        points.push_back({x * s + y * t, {0, 0, 1}});
    }
    points.push_back({{0, 0, 4}, {0, 0, -1}});  // behind
    on_each_ray_tree([&](Device& device) {
        const auto e = illuminate(device, scene, test::pack_receivers(points), {1, 0});
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(irradiance_at(e, i).x, i < 3 ? 2.0f : 0.0f, 1e-5f) << "receiver " << i;
        }
    });
}

TEST_F(ReceiverPathsDirectTest, SpotFallsOffLinearlyInTheAngle) {
    Scene scene;
    add_triangle(scene, {90, 90, 90}, {91, 90, 90}, {90, 91, 90}, add_material(scene, lambertian({1, 1, 1})));
    add_spot(scene, {0, 0, 0}, {0, 0, 1}, 20, 40);
    std::vector<ReceiverPoint> points;
    std::vector<float> expected;
    for (const float degrees : {0.0f, 10.0f, 19.9f, 25.0f, 30.0f, 39.0f, 40.1f, 90.0f, 170.0f}) {
        const float angle = degrees_to_radians(degrees);
        const Vec3 direction{std::sin(angle), 0, std::cos(angle)};
        points.push_back({direction * 2.0f, -direction});
        expected.push_back(3.0f / 4.0f * std::clamp((40 - degrees) / 20, 0.0f, 1.0f));
    }
    on_each_ray_tree([&](Device& device) {
        const auto e = illuminate(device, scene, test::pack_receivers(points), {1, 0});
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(irradiance_at(e, i).y, expected[i], 2e-5f) << "receiver " << i;
        }
    });
}

/// Sixty-four receivers near each other on the plane z = 0, facing up.
std::vector<ReceiverPoint> cluster() {
    std::vector<ReceiverPoint> points;
    Pcg32 random(6);
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        const float x = random.uniform();
        points.push_back({{x, random.uniform(), 0}, {0, 0, 1}});
    }
    return points;
}

/// Irradiance of a square lamp that faces down, by the midpoint rule.
double lamp_irradiance(Vec3 x, Vec3 corner, float side, double radiance) {
    constexpr int kSteps = 400;
    const double step = side / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double dx = corner.x + (i + 0.5) * step - x.x;
            const double dy = corner.y + (j + 0.5) * step - x.y;
            const double dz = corner.z - x.z;
            const double squared = dx * dx + dy * dy + dz * dz;
            sum += dz * dz / (squared * squared);
        }
    }
    return sum * step * step * radiance;
}

TEST_F(ReceiverPathsDirectTest, AreaLightAgreesWithQuadrature) {
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{3, 6, 9});
    const Vec3 corner{-0.5f, 0.2f, 0.8f};
    add_quad(scene, corner, {0, 1.5f, 0}, {1.5f, 0, 0}, add_material(scene, lamp));  // faces −Z
    const std::vector<ReceiverPoint> points = cluster();
    on_each_sample_count([&](Device& device, const Samples& samples) {
        const auto e = illuminate(device, scene, test::pack_receivers(points), samples);
        double ratio = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double expected = lamp_irradiance(points[i].position, corner, 1.5f, 6);
            EXPECT_NEAR(irradiance_at(e, i).y, expected, 0.04 * expected);
            EXPECT_NEAR(irradiance_at(e, i).x, 0.5 * irradiance_at(e, i).y, 1e-5 * expected);
            ratio += irradiance_at(e, i).y / expected / static_cast<double>(points.size());
        }
        EXPECT_NEAR(ratio, 1.0, 0.002);
    });
}

TEST_F(ReceiverPathsDirectTest, ConstantSkyGivesPiTimesItsRadianceInMean) {
    for (const int size : {1, 8}) {
        Scene scene;
        add_quad(scene, {-9, -9, -0.01f}, {18, 0, 0}, {0, 18, 0}, add_material(scene, lambertian({1, 1, 1})));
        scene.environment = {
            .width = 2 * size,
            .height = size,
            .radiance = std::vector<Vec3>(static_cast<std::size_t>(2 * size * size), {0.5f, 1, 2}),
            .to_world = rotation(1, 2, 3, 40)};
        const std::vector<ReceiverPoint> points = cluster();
        on_each_sample_count([&](Device& device, const Samples& samples) {
            const auto e = illuminate(device, scene, test::pack_receivers(points), samples);
            double mean = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_NEAR(irradiance_at(e, i).y, kPi, 0.03 * kPi);
                mean += irradiance_at(e, i).y / static_cast<double>(points.size());
            }
            EXPECT_NEAR(mean, kPi, 0.002 * kPi);
        });
    }
}

/// The disc of a sun, which is small against 1/cosθ, brings its radiance times its solid angle times cosθ.
TEST_F(ReceiverPathsDirectTest, SunBringsItsSolidAngle) {
    Scene scene;
    add_triangle(scene, {90, 90, 90}, {91, 90, 90}, {90, 91, 90}, add_material(scene, lambertian({1, 1, 1})));
    scene.environment = {.width = 1,
                         .height = 1,
                         .radiance = {{0, 0, 0}},
                         .to_world = {},
                         .sun_direction = {0, 0.6f, 0.8f},
                         .sun_half_angle = degrees_to_radians(0.2679f),
                         .sun_radiance = {20000, 10000, 5000}};
    const double half = 0.2679 * std::numbers::pi / 180;
    const double solid_angle = 4 * std::numbers::pi * std::pow(std::sin(half / 2), 2);
    on_each_sample_count([&](Device& device, const Samples& samples) {
        const auto e = illuminate(
            device, scene, test::pack_receivers({{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, -1, 0}}}), samples);
        EXPECT_NEAR(irradiance_at(e, 0).y, 10000 * solid_angle * 0.8, 1e-3 * 10000 * solid_angle);
        EXPECT_EQ(irradiance_at(e, 1).y, 0.0f);
    });
}

/// Only the top half of the environment shines, so a receiver that faces the horizon gets half of π·L.
TEST_F(ReceiverPathsDirectTest, HalfASkyGivesHalf) {
    Scene scene;
    add_triangle(scene, {90, 90, 90}, {91, 90, 90}, {90, 91, 90}, add_material(scene, lambertian({1, 1, 1})));
    scene.environment = {.width = 1, .height = 2, .radiance = {{2, 2, 2}, {0, 0, 0}}, .to_world = {}};
    on_each_sample_count([&](Device& device, const Samples& samples) {
        const auto e = illuminate(
            device, scene,
            test::pack_receivers({{{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {0, 0, 1}}}),
            {4 * samples.light, 4 * samples.rays});
        EXPECT_NEAR(irradiance_at(e, 0).x, 2 * kPi, 0.02f * kPi);
        EXPECT_EQ(irradiance_at(e, 1).x, 0.0f);
        EXPECT_NEAR(irradiance_at(e, 2).x, kPi, 0.02f * kPi);
    });
}

/// More than sixteen lights are chosen at random, with the same mean.
TEST_F(ReceiverPathsDirectTest, ManyPointLightsAgreeInMean) {
    Scene scene = scattered_squares();
    Pcg32 random(7);
    for (int i = 0; i < 40; ++i) {
        const Vec3 position = random_vector(random) + Vec3{0, 0, 2};
        add_point_light(scene, position, Vec3{1, 2, 0.5f} * (0.1f + random.uniform()));
    }
    const std::vector<ReceiverPacket> receivers = test::pack_receivers(cluster());
    std::vector<IrradiancePacket> expected(receivers.size());
    direct_reference(EmbreeScene(scene), scene, receivers, expected, 1);
    on_each_ray_tree([&](Device& device) {
        const std::vector<IrradiancePacket> found = illuminate(device, scene, receivers, {2048, 16});
        double want = 0;
        double have = 0;
        for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            want += irradiance_at(expected, i).y;
            have += irradiance_at(found, i).y;
            EXPECT_NEAR(irradiance_at(found, i).y, irradiance_at(expected, i).y,
                        0.1 * irradiance_at(expected, i).y);
        }
        EXPECT_NEAR(have, want, 0.005 * want);
    });
}

/// Compares the mean under lamp, sky and point lights with the reference's estimator, which samples
/// differently.
TEST_F(ReceiverPathsDirectTest, AllKindsOfLightTogetherAgreeWithTheReference) {
    Scene scene = scattered_squares();
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{3, 6, 9});
    add_quad(scene, {-0.5f, 0.2f, 1.5f}, {0, 0.5f, 0}, {0.5f, 0, 0}, add_material(scene, lamp));
    add_point_light(scene, {1, 1, 2}, {1, 1, 1});
    scene.environment = {
        .width = 2, .height = 1, .radiance = {{1, 0.5f, 0.5f}, {0.2f, 0.2f, 0.2f}}, .to_world = {}};
    const std::vector<ReceiverPoint> points = cluster();
    const EmbreeScene embree(scene);
    const LightSampler sampler(scene);
    Pcg32 random(8);
    double want = 0;
    constexpr int kSamples = 1000;
    for (const auto& [position, normal] : points) {
        for (int s = 0; s < kSamples; ++s) {
            const LightRandom u{random.uniform(), {random.uniform(), random.uniform()}};
            const Vec3 direction =
                Frame(normal).to_world(sample_cosine_hemisphere({random.uniform(), random.uniform()}));
            const BvhHit hit =
                embree.closest_hit(position, direction, 0.0f, std::numeric_limits<float>::infinity());
            want += (sampler.sampled_irradiance(embree, position, normal, u).y +
                     kPi * sampler.met_radiance(hit, position, direction, normal).y) /
                    kSamples;
        }
    }
    on_each_sample_count([&](Device& device, const Samples& samples) {
        const auto found = illuminate(device, scene, test::pack_receivers(points), samples);
        double have = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            have += irradiance_at(found, i).y;
        }
        EXPECT_NEAR(have, want, 0.01 * want);
    });
}

TEST_F(ReceiverPathsDirectTest, PacketsDoNotKnowOfEachOther) {
    Scene scene = scattered_squares();
    scene.environment = {.width = 1, .height = 1, .radiance = {{1, 1, 1}}, .to_world = {}};
    const std::vector<ReceiverPacket> receivers = random_receivers(500);
    on_each_ray_tree([&](Device& device) {
        const std::vector<IrradiancePacket> all = illuminate(device, scene, receivers, {4, 4});
        for (const std::size_t p : {std::size_t{0}, receivers.size() - 1}) {
            const auto alone = illuminate(device, scene, {receivers[p]}, {4, 4});
            EXPECT_EQ(std::memcmp(alone.data(), &all[p], sizeof(IrradiancePacket)), 0);
        }
        EXPECT_TRUE(is_zero(irradiance_at(all, 6)));  // an absent receiver
        const auto other_seed = illuminate(device, scene, receivers, {4, 4}, 2);
        EXPECT_NE(std::memcmp(other_seed.data(), all.data(), sizeof(IrradiancePacket)), 0);
    });
}

TEST_F(ReceiverPathsDirectTest, WithoutLightsItIsDark) {
    on_each_ray_tree([](Device& device) {
        const auto e = illuminate(device, scattered_squares(), random_receivers(64), {4, 4});
        for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            EXPECT_TRUE(is_zero(irradiance_at(e, i)));
        }
    });
}

}  // namespace
}  // namespace nearlight::core
