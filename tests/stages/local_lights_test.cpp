// SPDX-License-Identifier: Apache-2.0
#include "host/stages/local_lights.h"

#include <algorithm>
#include <functional>

#include "host/base/packed_direction.h"
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

class LocalLightsTest : public test::DeviceTest {};

constexpr uint kRays = 2;
constexpr std::size_t kSlotsPerPacket = std::size_t{kRays} * NEARLIGHT_PACKET_SIZE;
constexpr Vec3 kLamp{0.3f, 0.9f, 0.2f};
constexpr Vec3 kIntensity{3, 2, 1};

/// The inside of a corner: a floor, two walls of other albedos, and a floating square that casts shadows.
Scene lit_corner() {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambertian({0.8f, 0.7f, 0.6f})));
    add_quad(scene, {-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, add_material(scene, lambertian({0.5f, 0.2f, 0.1f})));
    add_quad(scene, {1, 0, -1}, {0, 0, 2}, {0, 2, 0}, add_material(scene, lambertian({0.1f, 0.6f, 0.2f})));
    add_quad(scene, {0.4f, 0.15f, 0.6f}, {0, 0, 0.35f}, {0.6f, 0, 0},
             add_two_sided(scene, lambertian({0.3f, 0.3f, 0.9f})));
    add_point_light(scene, kLamp, kIntensity);
    return scene;
}

Vec3 albedo_at(const Vpl& light) {
    if (light.normal.z < -0.5f) {
        return {0.5f, 0.2f, 0.1f};
    }
    if (light.normal.x < -0.5f) {
        return {0.1f, 0.6f, 0.2f};
    }
    return light.position.y < 0.1f ? Vec3{0.8f, 0.7f, 0.6f} : Vec3{0.3f, 0.3f, 0.9f};
}

/// Two packets on the floor and the back wall near the corner, with some receivers absent, and a third packet
/// without receivers.
std::vector<ReceiverPacket> receivers_in_corner() {
    constexpr float kExtent = 2.0f;  // of the corner
    Pcg32 random(5);
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 3 * NEARLIGHT_PACKET_SIZE; ++i) {
        const float a = 0.4f + 0.6f * random.uniform();
        const float b = 0.6f * random.uniform();
        const Vec3 normal = i % 3 == 0 ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
        const Vec3 position = i % 3 == 0 ? Vec3{a, b, 1} : Vec3{a, 0, 1 - b};
        const bool absent = i % 5 == 4 || i >= 2 * NEARLIGHT_PACKET_SIZE;
        points.push_back({moved_off(position, normal, kExtent), absent ? Vec3{0, 0, 0} : normal});
    }
    return test::pack_receivers(points);
}

/// The unbounded geometry term times visibility, in double precision except for the ray.
double pair_geometry(const Bvh& bvh, const ReceiverPoint& receiver, const Vpl& light, float radius) {
    const Vec3 between = receiver.position - light.position;
    const double height = dot(light.normal, between);
    const double cosine = -dot(receiver.normal, between);
    const double squared = dot(between, between);
    if (!(height > 2e-6) || !(cosine > 0) || !(squared < radius * radius) ||
        occluded(bvh, light.position, between, 1e-5f, 1.0f - 1e-5f)) {
        return 0;
    }
    return height * cosine / (squared * squared);
}

double density(const Bvh& bvh, const std::vector<ReceiverPacket>& receivers, std::size_t packet,
               const Vpl& light, float radius) {
    double sum = 0;
    for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        sum +=
            pair_geometry(bvh, receiver_at(receivers, packet * NEARLIGHT_PACKET_SIZE + lane), light, radius);
    }
    return kRays * sum / M_PI;
}

/// Exitance of a surface that only the lamp lights.
Vec3 exitance(const Bvh& bvh, const Vpl& light) {
    const Vec3 to_lamp = kLamp - light.position;
    const float squared = dot(to_lamp, to_lamp);
    const float cosine = dot(light.normal, to_lamp) / std::sqrt(squared);
    const bool dark = cosine <= 0 || occluded(bvh, light.position, to_lamp, 1e-5f, 1.0f - 1e-5f);
    return dark ? Vec3{0, 0, 0} : albedo_at(light) * kIntensity * (cosine / squared);
}

constexpr float kRadius = 0.5f;
LocalLightPlan plan_of(uint bounce_count) {
    return {.clamp_radius = 0.01f,
            .max_radius = kRadius,
            .rays_per_receiver = kRays,
            .direct_samples = 1,
            .bounce_count = bounce_count,
            .seed = 3};
}

TEST_F(LocalLightsTest, PowerIsExitanceOverTheDensityOfAllRaysOfThePacket) {
    on_each_device([](Device& device) {
        const SceneOnDevice on_device(device, lit_corner());
        const Bvh& bvh = on_device.bvh;
        const std::vector<ReceiverPacket> receivers = receivers_in_corner();
        LocalLightSlots slots(device, receivers.size() * kSlotsPerPacket);
        const std::size_t count = LocalLights(device).make(
            on_device.buffers, LocalVpls(device), Buffer<ReceiverPacket>(device, std::span(receivers)), 0,
            receivers.size(), plan_of(1), slots);
        const std::vector<Vpl> lights = slots.lights.download();
        const std::vector<uint> flags = slots.flags.download();
        EXPECT_EQ(count, static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1u)));
        EXPECT_GT(count, 30u);
        std::size_t different = 0;
        for (std::size_t slot = 0; slot < flags.size(); ++slot) {
            if (flags[slot] == 0) {
                continue;
            }
            const ReceiverPoint maker = receiver_at(
                receivers, slot / kSlotsPerPacket * NEARLIGHT_PACKET_SIZE + slot % NEARLIGHT_PACKET_SIZE);
            ASSERT_FALSE(is_zero(maker.normal));
            EXPECT_LT(length(maker.position - lights[slot].position), kRadius);
            const double p = density(bvh, receivers, slot / kSlotsPerPacket, lights[slot], kRadius);
            const Vec3 expected = exitance(bvh, lights[slot]) / static_cast<float>(p);
            different += length(lights[slot].power - expected) > 1e-3f * length(expected) ? 1 : 0;
        }
        EXPECT_LE(different, count / 50) << "more than shadow rays that meet an edge";
    });
}

TEST_F(LocalLightsTest, BitsSayWhichReceiversSeeALight) {
    on_each_device([](Device& device) {
        const SceneOnDevice on_device(device, lit_corner());
        const std::vector<ReceiverPacket> receivers = receivers_in_corner();
        LocalLightSlots slots(device, receivers.size() * kSlotsPerPacket);
        const std::size_t count = LocalLights(device).make(
            on_device.buffers, LocalVpls(device), Buffer<ReceiverPacket>(device, std::span(receivers)), 0,
            receivers.size(), plan_of(3), slots);
        std::vector<uint> indices = slots.indices.download();
        indices.resize(count);
        const std::vector<Vpl> lights = slots.lights.download();
        const std::vector<std::uint64_t> seen_by = slots.seen_by.download();
        int bits = 0;
        int wrong = 0;
        for (const uint slot : indices) {
            for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
                const ReceiverPoint receiver =
                    receiver_at(receivers, slot / kSlotsPerPacket * NEARLIGHT_PACKET_SIZE + lane);
                const bool expected = pair_geometry(on_device.bvh, receiver, lights[slot], kRadius) > 0;
                const bool found = (seen_by[slot] >> lane & 1u) != 0;
                bits += found ? 1 : 0;
                wrong += found != expected ? 1 : 0;
            }
        }
        EXPECT_GT(bits, 500);
        EXPECT_LE(wrong, bits / 200) << "more than rays that meet an edge";
    });
}

/// The light that local lights add to each receiver, over many seeds.
std::vector<Vec3> mean_addition(Device& device, const SceneOnDevice& scene,
                                const std::vector<ReceiverPacket>& receivers, float clamp_radius,
                                LocalLightPlan plan, int runs) {
    plan.clamp_radius = clamp_radius;
    LocalLights stage(device);
    const Buffer<ReceiverPacket> input(device, std::span(receivers));
    Buffer<IrradiancePacket> irradiance(device, receivers.size());
    irradiance.fill_zero();
    for (int run = 0; run < runs; ++run) {
        plan.seed = 100 + static_cast<uint>(run);
        stage.add(scene.buffers, LocalVpls(device), input, receivers.size(), plan, irradiance);
    }
    const std::vector<IrradiancePacket> sums = irradiance.download();
    std::vector<Vec3> means;
    for (std::size_t i = 0; i < receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        means.push_back(irradiance_at(sums, i) / static_cast<float>(runs));
    }
    return means;
}

constexpr Vec3 kWallNormal{0, 0, -1};

/// ∫ L_o (G_R − G_Rg) over the part of the wall z = 1, −1 ≤ x ≤ 1, 0 ≤ y ≤ 2 that a point of the floor does
/// not see from behind its shading normal, by the midpoint rule. `irradiance` of a point of the wall is
/// L_o·π, and R_g follows from it as the plan says.
double wall_remainder(Vec3 x, Vec3 shading, const LocalLightPlan& plan,
                      const std::function<double(Vec3)>& irradiance) {
    constexpr int kSteps = 1000;
    const double step = 2.0 / kSteps;
    const double depth = 1.0 - x.z;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double dx = -1 + (i + 0.5) * step - x.x;
            const double dy = (j + 0.5) * step - x.y;
            const double squared = dx * dx + dy * dy + depth * depth;
            const bool is_seen = dx * shading.x + dy * shading.y + depth * shading.z < 0;
            if (squared > plan.max_radius * plan.max_radius || dy < 0 || !is_seen) {
                continue;
            }
            const double e = irradiance({float(dx) + x.x, float(dy) + x.y, 1});
            double radius = plan.max_radius;
            for (int level = 1; level < 4 && radius * std::sqrt(e) > plan.radius_at_unit_light; ++level) {
                radius /= 2;
            }
            const auto bounded = [&](double r) { return 1 / std::max(squared, r * r); };
            sum += e / M_PI * depth * dy / squared * (bounded(plan.clamp_radius) - bounded(radius));
        }
    }
    return sum * step * step;
}

/// Receivers on the floor near the wall.
std::vector<ReceiverPoint> points_before_wall() {
    std::vector<ReceiverPoint> points;
    Pcg32 random(8);
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        const float x = 0.2f * random.uniform();
        points.push_back({{x, 1e-4f, 0.55f + 0.4f * random.uniform()}, {0, 1, 0}});
    }
    return points;
}

/// A white wall on a black floor, under a lamp.
Scene wall_under(Vec3 lamp, float intensity, Vec3 shading = kWallNormal) {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambertian({0, 0, 0})));
    add_quad(scene, {-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, add_material(scene, lambertian({1, 1, 1})));
    for (Vertex& vertex : std::span(scene.vertices).subspan(4)) {
        vertex.normal = shading;
    }
    add_point_light(scene, lamp, {intensity, intensity, intensity});
    return scene;
}

void expect_remainder_of_wall(Device& device, Vec3 lamp, float intensity, LocalLightPlan plan,
                              Vec3 shading = kWallNormal) {
    plan.clamp_radius = 0.1f;
    const auto irradiance = [&](Vec3 y) {
        const Vec3 to_lamp = lamp - y;
        return double(intensity) * dot(shading, to_lamp) / std::pow(double(length(to_lamp)), 3);
    };
    const std::vector<ReceiverPoint> points = points_before_wall();
    const SceneOnDevice scene(device, wall_under(lamp, intensity, shading));
    const std::vector<Vec3> found =
        mean_addition(device, scene, test::pack_receivers(points), plan.clamp_radius, plan, 4000);
    double expected_sum = 0;
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double expected = wall_remainder(points[i].position, shading, plan, irradiance);
        EXPECT_NEAR(found[i].y, expected, 0.1 * expected + 0.003) << "receiver " << i;
        expected_sum += expected;
        sum += found[i].y;
    }
    EXPECT_NEAR(sum, expected_sum, 0.015 * expected_sum);
}

/// The lamp is so far away that the wall's irradiance is even, I/d² = π.
TEST_F(LocalLightsTest, AddTheRemainderOfAWall) {
    on_each_device([](Device& device) {
        expect_remainder_of_wall(device, {0, 1, -1000}, 1e6f * kPi, plan_of(1));
    });
}

/// All receivers see a part of the wall from behind its shading normal, though not all the same part.
TEST_F(LocalLightsTest, AddNothingOfAWallThatIsSeenFromBehind) {
    on_each_device([](Device& device) {
        expect_remainder_of_wall(device, {0, 1, -1000}, 1e6f * kPi, plan_of(1),
                                 normalize({0.8f, 0.0f, -0.4f}));
    });
}

/// R_g is an eighth of the widest radius near the lamp, and the widest radius in the corners.
TEST_F(LocalLightsTest, AddTheRemainderWhereTheRadiusFollowsTheLight) {
    on_each_device([](Device& device) {
        LocalLightPlan plan = plan_of(1);
        plan.radius_at_unit_light = 0.2f;
        expect_remainder_of_wall(device, {0.1f, 0.3f, 0.6f}, 0.5f, plan);
    });
}

/// VPLs of one radius are gathered together, and none is lost.
TEST_F(LocalLightsTest, VplsAreGroupedByTheLightWhereTheyLie) {
    on_each_device([](Device& device) {
        const Vec3 lamp{0.1f, 0.3f, 0.6f};
        const SceneOnDevice scene(device, wall_under(lamp, 0.5f));
        std::vector<Vpl> vpls(300);
        Pcg32 random(3);
        for (Vpl& vpl : vpls) {
            const float x = 2 * random.uniform() - 1;
            vpl.position = {x, 2 * random.uniform(), 1 - 1e-4f};
            vpl.normal = {0, 0, -1};
        }
        LocalLightPlan plan = plan_of(1);
        plan.radius_at_unit_light = 0.2f;
        const LocalVpls found = LocalLights(device).group(scene.buffers, vpls, plan);
        ASSERT_EQ(found.groups.size(), 4u);
        std::size_t count = 0;
        for (const LocalVpls::Group& group : found.groups) {
            count += group.count;
            for (const Vpl& vpl : group.vpls.download()) {
                const double distance = length(lamp - vpl.position);
                const double wanted =
                    plan.radius_at_unit_light / std::sqrt(0.5 * 0.4 / std::pow(distance, 3));
                EXPECT_TRUE(group.radius <= wanted * 1.001 || group.radius == kRadius / 8);
                EXPECT_TRUE(2 * group.radius > wanted * 0.999 || group.radius == kRadius);
            }
        }
        EXPECT_EQ(count, vpls.size());
        plan.clamp_radius = kRadius / 3;
        for (const LocalVpls::Group& group : LocalLights(device).group(scene.buffers, vpls, plan).groups) {
            EXPECT_GE(group.radius, plan.clamp_radius);
        }
    });
}

TEST_F(LocalLightsTest, NothingRemainsWhereBothRadiiAreTheSame) {
    on_each_device([](Device& device) {
        const SceneOnDevice on_device(device, lit_corner());
        const std::vector<ReceiverPacket> receivers = receivers_in_corner();
        for (const Vec3 e : mean_addition(device, on_device, receivers, kRadius, plan_of(2), 2)) {
            EXPECT_NEAR(max_component(e), 0.0f, 1e-6f);
        }
    });
}

/// No packet uses the lights of another, so that cuts of the picture do not show.
TEST_F(LocalLightsTest, APacketGetsTheSameWithoutTheOthers) {
    on_each_device([](Device& device) {
        const SceneOnDevice scene(device, lit_corner());
        const std::vector<ReceiverPacket> both = receivers_in_corner();
        const std::vector<Vec3> together = mean_addition(device, scene, both, 0.01f, plan_of(2), 1);
        const std::vector<Vec3> alone = mean_addition(device, scene, {both[1]}, 0.01f, plan_of(2), 1);
        float sum = 0;
        for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            EXPECT_EQ(alone[i], together[NEARLIGHT_PACKET_SIZE + i]) << i;
            sum += max_component(alone[i]);
        }
        EXPECT_GT(sum, 0);
    });
}

/// Curve 1 lets a half through at all angles. The map takes more of light that is low over the mesh, and all
/// from behind it.
TEST_F(LocalLightsTest, TheReceiversCoatAndMapTakeTheirParts) {
    on_each_device([](Device& device) {
        Scene room = lit_corner();
        room.transmission_curves.resize(2 * std::size_t{NEARLIGHT_CURVE_SIZE}, 0.5f);
        const SceneOnDevice scene(device, room);
        std::vector<ReceiverPacket> packets = receivers_in_corner();
        const std::vector<Vec3> bare = mean_addition(device, scene, packets, 0.01f, plan_of(1), 1);
        for (ReceiverPacket& packet : packets) {
            std::ranges::fill(packet.surface, 1u);
        }
        const std::vector<Vec3> coated = mean_addition(device, scene, packets, 0.01f, plan_of(1), 1);
        for (std::size_t i = 0; i < bare.size(); ++i) {
            EXPECT_NEAR(coated[i].y, 0.5f * bare[i].y, 1e-4f * bare[i].y) << i;
        }
        for (ReceiverPacket& packet : packets) {
            std::ranges::fill(packet.mesh_normal, pack_direction({0, 0.6f, -0.8f}));
        }
        const std::vector<Vec3> mapped = mean_addition(device, scene, packets, 0.01f, plan_of(1), 1);
        double sum = 0;
        double unshadowed = 0;
        for (std::size_t i = 0; i < bare.size(); ++i) {
            EXPECT_LE(mapped[i].y, coated[i].y) << i;
            sum += mapped[i].y;
            unshadowed += coated[i].y;
        }
        EXPECT_GT(sum, 0.1 * unshadowed);
        EXPECT_LT(sum, 0.9 * unshadowed);
    });
}

TEST_F(LocalLightsTest, AbsentReceiversGetNothingAndOthersSomething) {
    on_each_device([](Device& device) {
        const SceneOnDevice on_device(device, lit_corner());
        const std::vector<ReceiverPacket> receivers = receivers_in_corner();
        const std::vector<Vec3> found = mean_addition(device, on_device, receivers, 0.01f, plan_of(2), 1);
        int lit = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const bool absent = is_zero(receiver_at(receivers, i).normal);
            EXPECT_TRUE(!absent || is_zero(found[i])) << i;
            lit += is_zero(found[i]) ? 0 : 1;
        }
        EXPECT_GT(lit, 80);
    });
}

}  // namespace
}  // namespace nearlight::core
