// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_lights.h"

#include <algorithm>
#include <cmath>

#include "host/base/math.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/shared_light_oracle.h"
#include "host/reference/test_rooms.h"
#include "host/scene/material_model.h"
#include "host/stages/receiver_paths.h"
#include "tests/support/brought_light.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::brought;
using test::Brought;

class SharedLightsTest : public test::DeviceTest {};

constexpr std::size_t kReceivers = std::size_t{NEARLIGHT_BUNDLE_PACKETS} * NEARLIGHT_PACKET_SIZE;
constexpr float kRadius = 0.8f;

/// A floor and a wall of one material under a point light, and a shelf on the wall that shades a part of the
/// floor.
Scene corner_with_shelf(const Material& material) {
    Scene scene;
    const uint surface = add_material(scene, material);
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, surface);
    add_quad(scene, {-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, surface);
    add_quad(scene, {-0.3f, 0.2f, 0.8f}, {0, 0, 0.2f}, {0.6f, 0, 0},
             add_two_sided(scene, lambertian({0.3f, 0.4f, 0.5f})));
    add_point_light(scene, {0.2f, 1.0f, 0.1f}, {1, 2, 3});
    return scene;
}

/// Receivers on a grid of the floor near the wall; every fifth is absent.
std::vector<ReceiverPacket> receivers_near_the_wall(std::size_t count = kReceivers) {
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = -0.6f + 0.08f * static_cast<float>(i % 16);
        const float z = 0.5f + 0.49f / 16 * static_cast<float>(i / 16);
        points.push_back({{x, 1e-4f, z}, i % 5 == 4 ? Vec3{0, 0, 0} : Vec3{0, 1, 0}});
    }
    return test::pack_receivers(points);
}

constexpr ReceiverPathSettings kTwoRays{.rays = 2, .max_edges = 4, .clamp_radius = kRadius};
constexpr ReceiverPathSettings kManyRays{.rays = 512, .max_edges = 4, .clamp_radius = kRadius};

void expect_the_light_of_own_rays(Device& device, const Scene& scene,
                                  const std::vector<ReceiverPacket>& packets, GatherKernel kernel,
                                  const ReceiverPathSettings& settings = kTwoRays) {
    const Brought own = brought(device, scene, packets, false, kManyRays, 32, kernel);
    const Brought shared = brought(device, scene, packets, true, settings, 2048, kernel);
    ASSERT_GT(own.sum(), 1.0);
    EXPECT_NEAR(shared.sum(), own.sum(), 0.005 * own.sum());
    for (std::size_t i = 0; i < own.mean.size(); ++i) {
        EXPECT_NEAR(shared.mean[i], own.mean[i], 0.15 * own.mean[i] + 1e-3) << i;
    }
}

TEST_F(SharedLightsTest, BringWhatOwnRaysBring) {
    on_each_device([](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::rays ? "single rays" : "packets");
            expect_the_light_of_own_rays(device, corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f})),
                                         receivers_near_the_wall(), kernel);
        }
    });
}

/// Coats have curves at both ends, and reflect other than diffusely, which each receiver finds by itself.
TEST_F(SharedLightsTest, BringWhatOwnRaysBringBelowCoats) {
    on_each_device([](Device& device) {
        Scene scene = corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f}));
        scene.materials[0] = coated(scene, {0.5f, 0.5f, 0.5f}, {.eta = 1.5});
        std::vector<ReceiverPacket> packets = receivers_near_the_wall();
        for (ReceiverPacket& packet : packets) {
            std::ranges::fill(packet.surface, scene.materials[0].curve);
        }
        expect_the_light_of_own_rays(device, scene, packets, GatherKernel::automatic);
    });
}

/// Much of what rays bring from a lamp that is large to the wall is above the limit.
TEST_F(SharedLightsTest, BringWhatOwnRaysBringUpToALimit) {
    on_each_device([](Device& device) {
        Scene scene = corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f}));
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(Vec3{2, 3, 4});
        add_quad(scene, {-0.6f, 0.7f, 0.2f}, {1.2f, 0, 0}, {0, 0, 0.7f}, add_material(scene, lamp));
        const std::vector<ReceiverPacket> packets = receivers_near_the_wall();
        const ReceiverPathSettings limited = test::with_limit(kTwoRays, 0.02f);
        EXPECT_GT(brought(device, scene, packets, true, limited, 64).variance(),
                  1.03 * brought(device, scene, packets, true, kTwoRays, 64).variance())
            << "the limit changes nothing";
        expect_the_light_of_own_rays(device, scene, packets, GatherKernel::automatic, limited);
    });
}

TEST_F(SharedLightsTest, AreLessNoiseThanOwnRays) {
    on_each_device([](Device& device) {
        const Scene scene = corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f}));
        const std::vector<ReceiverPacket> packets = receivers_near_the_wall();
        const Brought own = brought(device, scene, packets, false, kTwoRays, 32);
        const Brought shared = brought(device, scene, packets, true, kTwoRays, 32);
        EXPECT_LT(shared.variance(), 0.3 * own.variance());
    });
}

/// A last bundle may have a single packet.
TEST_F(SharedLightsTest, BundlesDoNotShareWithEachOther) {
    on_each_device([](Device& device) {
        const Scene scene = corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f}));
        std::vector<ReceiverPacket> packets = receivers_near_the_wall();
        const Brought alone = brought(device, scene, packets, true, kTwoRays, 1);
        packets.push_back(packets[2]);
        const Brought together = brought(device, scene, packets, true, kTwoRays, 1);
        for (std::size_t i = 0; i < kReceivers; ++i) {
            EXPECT_EQ(together.mean[i], alone.mean[i]) << i;
        }
        double last = 0;
        for (std::size_t i = kReceivers; i < together.mean.size(); ++i) {
            last += together.mean[i];
        }
        EXPECT_GT(last, 0);
    });
}

/// Paths of receivers behind panes are shorter, and maps weigh light in another way.
TEST_F(SharedLightsTest, ReceiversThatDifferKeepTheirOwnRays) {
    on_each_device([](Device& device) {
        const Scene scene = corner_with_shelf(lambertian({0.5f, 0.5f, 0.5f}));
        std::vector<ReceiverPacket> packets = receivers_near_the_wall();
        std::ranges::fill(packets[0].surface, 1u << NEARLIGHT_RECEIVER_SURFACES_SHIFT);
        std::ranges::fill(packets[1].mesh_normal, 32768u | 65535u << 16);  // pack_direction() of (0, 1, 0)
        const Brought own = brought(device, scene, packets, false, kTwoRays, 1);
        const Brought shared = brought(device, scene, packets, true, kTwoRays, 1);
        const std::size_t differing = 2 * std::size_t{NEARLIGHT_PACKET_SIZE};
        EXPECT_EQ(std::vector(shared.mean.begin(), shared.mean.begin() + differing),
                  std::vector(own.mean.begin(), own.mean.begin() + differing));
        EXPECT_NE(shared.mean, own.mean);
        ReceiverPathSettings long_paths = kTwoRays;
        long_paths.max_edges = 64;
        EXPECT_NE(brought(device, scene, packets, true, long_paths, 1).mean[0],
                  brought(device, scene, packets, false, long_paths, 1).mean[0])
            << "an edge less of many does not matter";
    });
}

/// The sum over listed lights is exact where a bundle uses all of them.
TEST_F(SharedLightsTest, AgreeWithEmbree) {
    on_each_device([](Device& device) {
        Scene scene = make_delta_lit_room();
        scene.transmission_curves.assign(2 * std::size_t{NEARLIGHT_CURVE_SIZE}, 0.5f);
        const Bvh bvh = build_scene_bvh(scene);
        const EmbreeScene embree(scene);
        const float extent = max_component(bounds(scene).size());
        const SharedLightCase data = make_shared_lights(
            make_camera_receivers(scene, bvh, 24, 24), 0.3f * extent, [&](Vec3 from, Vec3 to) {
                return distance_to_edges(bvh.triangles, from, to) > kSegmentEdgeTolerance * extent;
            });
        const std::vector<Vec3> wanted = shared_irradiance(
            data, [&](Vec3 from, Vec3 to) { return !embree.blocked(from, to); }, [](double) { return 0.5; });
        const ReceiverPathSettings settings{.rays = data.rays_per_receiver,
                                            .max_edges = data.max_edges,
                                            .clamp_radius = data.clamp_radius,
                                            .seed = 1};
        const auto lit = std::ranges::count_if(wanted, [](Vec3 light) { return light.z > 0; });
        EXPECT_GT(lit, static_cast<std::ptrdiff_t>(wanted.size() / 2));
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            const DeviceScene on_device = upload_scene(device, scene, bvh, kernel);
            Buffer<IrradiancePacket> irradiance(device, data.receivers.size());
            irradiance.fill_zero();
            SharedLightLists lists(device, kernel);
            SharedLights(device).add(
                {on_device, Buffer<ReceiverPacket>(device, data.receivers), data.receivers.size(), settings},
                lists, Buffer<SharedLight>(device, data.found), irradiance);
            const std::vector<IrradiancePacket> found = irradiance.download();
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                const Vec3 difference = irradiance_at(found, i) - wanted[i];
                ASSERT_LE(length(difference), 1e-3f * length(wanted[i]) + 1e-6f) << i;
            }
        }
    });
}

/// Of two lights, a receiver keeps either in proportion to its weight, and each then stands for both.
TEST_F(SharedLightsTest, AReceiverKeepsEachOfItsFindsByItsWeight) {
    on_each_device([](Device& device) {
        test::KernelProbe probe(device, R"(
#include "lib/random.cl"
#include "lib/shared_light.cl"
kernel void probe(global float* out) {
    const uint i = (uint)get_global_id(0);
    FoundLight found = nothing_found(1);
    for (uint k = 0; k < 2; ++k) {
        SharedLight light = nothing_found(1).light;
        light.weight = k == 0 ? 1.0f : 3.0f;
        light.radiance = store3(k == 0 ? (float3)(1.0f, 0.0f, 0.0f) : (float3)(0.0f, 3.0f, 0.0f));
        offer_light(&found, &light, to_unit_float(random_uint4((uint4)(i, k, 3, 4)).x));
    }
    const SharedLight kept = kept_light(&found);
    out[3 * i] = kept.radiance.x;
    out[3 * i + 1] = kept.radiance.y;
    out[3 * i + 2] = kept.weight;
}
)");
        constexpr std::size_t kDraws = 4096;
        Buffer<float> out(probe.device(), 3 * kDraws);
        probe.kernel().launch(kDraws, 1, out);
        const std::vector<float> kept = out.download();
        double first = 0;
        for (std::size_t i = 0; i < kDraws; ++i) {
            EXPECT_FLOAT_EQ(kept[3 * i] + kept[3 * i + 1], 4.0f);
            EXPECT_FLOAT_EQ(kept[3 * i + 2], 4.0f);
            first += kept[3 * i] > 0 ? 1.0 / kDraws : 0.0;
        }
        EXPECT_NEAR(first, 0.25, 5 * std::sqrt(0.25 * 0.75 / kDraws));
    });
}

TEST_F(SharedLightsTest, NothingFoundAddsNothing) {
    on_each_device([](Device& device) {
        const Scene scene = corner_with_shelf(lambertian({0, 0, 0}));
        EXPECT_EQ(brought(device, scene, receivers_near_the_wall(), true, kTwoRays, 1).sum(), 0.0);
    });
}

}  // namespace
}  // namespace nearlight::core
