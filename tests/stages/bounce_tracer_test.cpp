// SPDX-License-Identifier: Apache-2.0
#include "host/stages/bounce_tracer.h"
#include "host/base/math.h"

#include "host/stages/gatherer.h"
#include "host/stages/light_tracer.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class BounceTracerTest : public test::DeviceTest {};

constexpr float kAlbedo = 0.5f;

/// A floor under a point light, between a wall and a ceiling.
Scene corner() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo}));
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, grey);
    add_quad(scene, {-1, 0, 1}, {0, 2, 0}, {2, 0, 0}, grey);
    add_quad(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, grey);
    add_point_light(scene, {0.2f, 1.0f, 0.1f}, {1, 2, 3});
    return scene;
}

/// A packet with all lanes at about one point of the floor, near the wall. Tiny shifts give them different
/// random numbers.
ReceiverPacket receivers_near_the_wall() {
    ReceiverPacket packet{};
    for (int lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        packet.px[lane] = 1e-5f * static_cast<float>(lane);
        packet.py[lane] = 1e-4f;
        packet.pz[lane] = 0.9f;
        packet.ny[lane] = 1;
    }
    return packet;
}

double mean_green(const Buffer<IrradiancePacket>& irradiance) {
    const IrradiancePacket packet = irradiance.download_one(0);
    double sum = 0;
    for (const float value : packet.g) {
        sum += value;
    }
    return sum / NEARLIGHT_PACKET_SIZE;
}

struct CornerLight {
    CornerLight(Device& on_device, const Scene& scene)
        : device(on_device),
          on_gpu(device, scene),
          packet(receivers_near_the_wall()),
          receivers(device, std::span(&packet, 1)) {}

    double traced(float radius, uint bounces, uint samples) {
        Buffer<IrradiancePacket> irradiance(device, 1);
        irradiance.fill_zero();
        BounceTracer(device).run(
            on_gpu.buffers, receivers, 1,
            {.sample_count = samples, .bounce_count = bounces, .clamp_radius = radius, .seed = 4},
            irradiance);
        return mean_green(irradiance);
    }
    double gathered(float radius, uint bounces) {
        const CloseRange nothing{};
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::span(&nothing, 1));
        region.triangles = Buffer<uint>(device, std::vector<uint>(on_gpu.buffers.host_info.triangle_count));
        const std::vector<Vpl> vpls =
            LightTracer(device).run(on_gpu.buffers, region, KeepDeposits::all,
                                    {.walk_count = 200'000, .bounce_count = bounces, .seed = 1});
        GatherSums<Vpl> sums(device, 1);
        Gatherer(device).gather({.tree = on_gpu.buffers.tree,
                                 .vpls = Buffer<Vpl>(device, std::span(vpls)),
                                 .vpl_count = vpls.size(),
                                 .receivers = receivers,
                                 .packet_count = 1,
                                 .clamp_radius = radius},
                                sums);
        return mean_green(sums.light);
    }

    Device& device;
    SceneOnDevice on_gpu;
    ReceiverPacket packet;
    Buffer<ReceiverPacket> receivers;
};

TEST_F(BounceTracerTest, SuppliesWhatABoundedGatherLeavesOut) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        const double all = setup.traced(kInfinity, 4, 4096);
        for (const float radius : {0.3f, 1.0f}) {
            const double bounded = setup.gathered(radius, 4);
            const double rest = setup.traced(radius, 4, 4096);
            EXPECT_GT(rest, 0.03 * all) << "nothing to tell by";
            EXPECT_NEAR(bounded + rest, all, 0.015 * all) << "radius " << radius;
        }
    });
}

TEST_F(BounceTracerTest, DeeperPathsBringMoreAndAgreeWithWalksOfThatDepth) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        double before = 0;
        for (const uint bounces : {1, 2, 5}) {
            const double traced = setup.traced(kInfinity, bounces, 4096);
            // The bound is tiny, because single deposits beside the point would otherwise be outliers.
            const double gathered = setup.gathered(0.05f, bounces);
            EXPECT_NEAR(traced, gathered, 0.02 * traced) << bounces;
            EXPECT_GT(traced, 1.02 * before);
            before = traced;
        }
    });
}

TEST_F(BounceTracerTest, AddsNothingWhereThereIsNothingToTrace) {
    on_each_device([](Device& device) {
        CornerLight setup(device, corner());
        EXPECT_EQ(setup.traced(0.0f, 4, 16), 0.0);
        EXPECT_EQ(setup.traced(1.0f, 0, 16), 0.0);
        EXPECT_EQ(setup.traced(1.0f, 4, 0), 0.0);
        Scene dark = corner();
        dark.delta_emitters.clear();
        EXPECT_EQ(CornerLight(device, dark).traced(1.0f, 4, 16), 0.0);
    });
}

}  // namespace
}  // namespace nearlight::core
