// SPDX-License-Identifier: Apache-2.0
#include "host/reference/reference_gather.h"

#include <gtest/gtest.h>

#include "host/base/random.h"
#include "host/reference/path_tracer.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A wall at x = 0 that fills z > 0.
Scene half_wall() {
    Scene scene;
    add_quad(scene, {0, -5, 0}, {0, 10, 0}, {0, 0, 10}, add_material(scene, lambertian({1, 1, 1})));
    return scene;
}

/// A packet with lane 0 in front of the wall's end, lane 1 behind the wall, and the other lanes absent.
ReceiverPacket two_receivers() {
    ReceiverPacket packet{};
    packet.px[0] = packet.px[1] = 1.0f;
    packet.pz[0] = -1.0f;
    packet.pz[1] = 1.0f;
    packet.nx[0] = packet.nx[1] = -1.0f;
    return packet;
}

Vpl vpl_at(Vec3 position, Vec3 normal, Vec3 power) {
    Vpl vpl{};
    vpl.position = position;
    vpl.normal = normal;
    vpl.power = power;
    return vpl;
}

TEST(ReferenceGather, SumsTheBoundedTermOfWhatIsVisible) {
    const EmbreeScene embree(half_wall());
    const std::vector<Vpl> vpls{vpl_at({-1, 0, -1}, {1, 0, 0}, {1, 2, 3}),     // r = 2 to lane 0, faces it
                                vpl_at({-1, 0, -1}, {-1, 0, 0}, {9, 9, 9}),    // faces away
                                vpl_at({0.9f, 0, -1}, {1, 0, 0}, {1, 1, 1})};  // r = 0.1
    const std::vector<ReceiverPacket> receivers{two_receivers()};
    std::vector<IrradiancePacket> irradiance(1);
    gather_reference(embree, std::span(vpls).first(2), 0.0f, receivers, irradiance);
    EXPECT_NEAR(irradiance[0].g[0], 2 / (kPi * 4), 1e-6);
    EXPECT_NEAR(irradiance[0].b[0], 3 / (kPi * 4), 1e-6);
    EXPECT_EQ(irradiance[0].r[2], 0.0f);
    // The segment from (−1, 0, −1) to lane 1 at (1, 0, 1) would pass exactly through the wall's edge, so it
    // is moved.
    const std::vector<Vpl> behind{vpl_at({-1, 0, 0}, {1, 0, 0}, {1, 1, 1})};
    gather_reference(embree, behind, 0.0f, receivers, irradiance);
    EXPECT_EQ(irradiance[0].r[1], 0.0f);
    EXPECT_GT(irradiance[0].r[0], 0.0f);
    for (const float radius : {0.05f, 0.5f}) {
        gather_reference(embree, std::span(vpls).last(1), radius, receivers, irradiance);
        EXPECT_NEAR(irradiance[0].r[0], 1 / (kPi * std::max(0.01f, radius * radius)),
                    1e-3 / (radius * radius));
    }
}

TEST(ReferenceGather, DirectLightIsIntensityOverDistanceSquared) {
    const EmbreeScene embree(half_wall());
    Scene lights;
    add_point_light(lights, {-1, 0, -1}, {4, 4, 4});
    Emitter spot = lights.delta_emitters[0];
    spot.type = NEARLIGHT_EMITTER_SPOT;
    spot.direction = normalize(Vec3{2, 0, 2});  // lane 0 is 45° off the axis
    spot.beam_angle = degrees_to_radians(30);
    spot.cutoff_angle = degrees_to_radians(60);
    const std::vector<ReceiverPacket> receivers{two_receivers()};
    std::vector<IrradiancePacket> irradiance(1);
    direct_reference(embree, lights, receivers, irradiance);
    EXPECT_NEAR(irradiance[0].r[0], 1.0f, 1e-5);
    lights.delta_emitters = {spot};
    direct_reference(embree, lights, receivers, irradiance);
    EXPECT_NEAR(irradiance[0].r[0], 0.5f, 1e-4);
}

TEST(ReferenceGather, ThreadsDoNotMatter) {
    const EmbreeScene embree(half_wall());
    Pcg32 random(1);
    std::vector<Vpl> vpls;
    for (int i = 0; i < 200; ++i) {
        vpls.push_back(
            vpl_at({-random.uniform(), random.uniform(), random.uniform() - 0.5f}, {1, 0, 0}, {1, 1, 1}));
    }
    std::vector<ReceiverPacket> receivers(5, two_receivers());
    std::vector<IrradiancePacket> one(5), four(5);
    gather_reference(embree, vpls, 0.1f, receivers, one, 1);
    gather_reference(embree, vpls, 0.1f, receivers, four, 4);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(one[i].r[0], four[i].r[0]);
        EXPECT_EQ(one[i].r[1], one[0].r[1]);
    }
    EXPECT_GT(one[0].r[0], one[0].r[1]);
}

/// Two squares of side 2 facing each other at distance 1, a blocker between, and a light beside the blocker.
Scene facing_squares() {
    Scene scene;
    const uint material = add_two_sided(scene, lambertian({0.8f, 0.8f, 0.8f}));
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, material);
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, material);
    const uint black = add_material(scene, lambertian({0, 0, 0}));
    add_quad(scene, {-0.9f, 0.4f, -0.6f}, {0.6f, 0, 0}, {0, 0, 1.2f}, black);
    add_point_light(scene, {0.2f, 0.6f, 0.1f}, {1, 1, 1});
    set_camera(scene, {0.0, 0.5, 0.0}, {0.3, 0.0, 0.2}, 0.05);
    return scene;
}

/// VPLs on a grid over the upper square that stand for the light that the square reflects.
std::vector<Vpl> grid_of_vpls(int side) {
    std::vector<Vpl> vpls;
    for (int i = 0; i < side * side; ++i) {
        const float cell = 2.0f / static_cast<float>(side);
        const Vec3 position{-1 + cell * (static_cast<float>(i % side) + 0.5f), 1 - 2e-5f,
                            -1 + cell * (static_cast<float>(i / side) + 0.5f)};
        const Vec3 to_light = Vec3{0.2f, 0.6f, 0.1f} - position;
        const float irradiance = -to_light.y / (dot(to_light, to_light) * length(to_light));
        const float power = 0.8f * irradiance * cell * cell;
        vpls.push_back(vpl_at(position, {0, -1, 0}, {power, power, power}));
    }
    return vpls;
}

TEST(ReferenceGather, ManyVplsAreTheClampedPathTracer) {
    const Scene scene = facing_squares();
    const EmbreeScene embree(scene);
    std::vector<ReceiverPacket> receivers(1);
    receivers[0].px[0] = 0.3f;
    receivers[0].py[0] = 2e-5f;
    receivers[0].pz[0] = 0.2f;
    receivers[0].ny[0] = 1.0f;
    std::vector<IrradiancePacket> irradiance(1);
    for (const float radius : {0.0f, 1.3f}) {
        gather_reference(embree, grid_of_vpls(300), radius, receivers, irradiance);
        const Image image = trace_paths(scene, {.width = 4,
                                                .height = 4,
                                                .spp = 8192,
                                                .max_depth = 3,
                                                .clamp_radius = radius,
                                                .indirect_only = true});
        const double expected = irradiance[0].r[0] * 0.8 / kPi;
        EXPECT_NEAR(channel_mean(image, "R"), expected, 4.5 * standard_error(image) + 2e-3 * expected);
    }
}

}  // namespace
}  // namespace nearlight::core
