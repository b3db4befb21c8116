// SPDX-License-Identifier: Apache-2.0
#include "host/stages/patch_vpls.h"

#include "host/base/random.h"
#include "host/scene/pinhole_camera.h"
#include "host/scene/ray_epsilon.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class PatchVplsTest : public test::DeviceTest {};

constexpr uint kSamples = 100;  // two packets of samples, the second not full
constexpr std::size_t kSlots = 256;

/// A one-sided wall (triangles 0 and 1) and a two-sided one (2 and 3), seen from the origin.
Scene two_walls() {
    Scene scene;
    const uint one = add_material(scene, lambertian({0.5f, 0.25f, 0.125f}));
    Material both = lambertian({0.2f, 0.4f, 0.8f});
    both.flags = NEARLIGHT_MATERIAL_TWO_SIDED;
    const uint two = add_material(scene, both);
    add_quad(scene, {-2, -2, 2}, {0, 4, 0}, {4, 0, 0}, one);
    add_quad(scene, {-2, -2, 3}, {0, 4, 0}, {4, 0, 0}, two);
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 60);
    return scene;
}

std::vector<SurfaceSample> samples_on(const Scene& scene) {
    Pcg32 random(2);
    std::vector<SurfaceSample> samples(kSamples);
    for (uint i = 0; i < kSamples; ++i) {
        samples[i].triangle = i % 4;
        samples[i].position = {4 * random.uniform() - 2, 0.0f, i % 4 < 2 ? 2.0f : 3.0f};
        samples[i].position.y = 4 * random.uniform() - 2;
        samples[i].normal = {0, 0, -1};
    }
    EXPECT_EQ(scene.triangles.size(), 4u);
    return samples;
}

/// Slot of a side of a sample.
std::size_t slot_of(std::size_t sample, bool front) {
    return (sample / NEARLIGHT_PACKET_SIZE * 2 + (front ? 0 : 1)) * NEARLIGHT_PACKET_SIZE +
           sample % NEARLIGHT_PACKET_SIZE;
}

struct PatchResult {
    std::vector<ReceiverPacket> receivers;
    std::vector<Vpl> vpls;
    std::vector<uint> flags;
};

/// Irradiance of slot s is (s, 2s, 0).
PatchResult make_patches(Device& device, const Scene& scene, bool whole_triangles) {
    const SceneOnDevice on_device(device, scene);
    const CloseRange range = make_close_range(make_pinhole_camera(scene.camera, 64, 64), 2.6f);
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&range, 1));
    region.whole_triangles = whole_triangles;
    const std::size_t packets = patch_packet_count(kSamples);
    EXPECT_EQ(packets * NEARLIGHT_PACKET_SIZE, kSlots);
    std::vector<IrradiancePacket> light(packets);
    for (std::size_t s = 0; s < kSlots; ++s) {
        light[s / NEARLIGHT_PACKET_SIZE].r[s % NEARLIGHT_PACKET_SIZE] = static_cast<float>(s);
        light[s / NEARLIGHT_PACKET_SIZE].g[s % NEARLIGHT_PACKET_SIZE] = 2 * static_cast<float>(s);
    }
    const Buffer<SurfaceSample> samples(device, samples_on(scene));
    Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<Vpl> vpls(device, kSlots);
    Buffer<uint> flags(device, std::vector<uint>(kSlots, 7));
    PatchVpls stage(device);
    stage.make_receivers(on_device.buffers, samples, kSamples, region, receivers);
    stage.make_vpls(on_device.buffers, samples, kSamples, receivers, Buffer<IrradiancePacket>(device, light),
                    0.25f, vpls, flags);
    return {receivers.download(), vpls.download(), flags.download()};
}

/// Half the field of view is 30°, the range 2.6 m.
bool in_region(Vec3 p) {
    const float edge = p.z * std::tan(degrees_to_radians(30));
    return std::abs(p.x) <= edge && std::abs(p.y) <= edge && length(p) < 2.6f;
}

TEST_F(PatchVplsTest, SidesThatReflectBecomeReceivers) {
    const Scene scene = two_walls();
    const std::vector<SurfaceSample> samples = samples_on(scene);
    on_each_device([&](Device& device) {
        for (const bool whole : {true, false}) {
            const PatchResult result = make_patches(device, scene, whole);
            std::size_t present = 0;
            for (std::size_t i = 0; i < kSlots / 2; ++i) {
                for (const bool front : {true, false}) {
                    const auto [position, normal] = test::receiver_at(result.receivers, slot_of(i, front));
                    const bool expected = i < kSamples && (whole || in_region(samples[i].position)) &&
                                          (front || samples[i].triangle >= 2);
                    ASSERT_EQ(!is_zero(normal), expected) << "sample " << i << (front ? " front" : " back");
                    if (expected) {
                        const Vec3 side = front ? samples[i].normal : -samples[i].normal;
                        EXPECT_EQ(normal, side);
                        EXPECT_NEAR(length(position - stand_off(samples[i].position, side, 4.0f)), 0.0f,
                                    1e-6f);
                        ++present;
                    }
                }
            }
            EXPECT_GT(present, 10u);
        }
    });
}

TEST_F(PatchVplsTest, PowerIsAlbedoTimesIrradianceTimesArea) {
    const Scene scene = two_walls();
    const std::vector<SurfaceSample> samples = samples_on(scene);
    on_each_device([&](Device& device) {
        const PatchResult result = make_patches(device, scene, true);
        for (std::size_t i = 0; i < kSlots / 2; ++i) {
            for (const bool front : {true, false}) {
                const std::size_t slot = slot_of(i, front);
                // Slot 0 got no light.
                ASSERT_EQ(result.flags[slot], i < kSamples && slot > 0 ? 1u : 0u);
                if (result.flags[slot] == 0) {
                    continue;
                }
                const Vec3 albedo = scene.materials[samples[i].triangle / 2].base;
                const auto e = static_cast<float>(slot);
                const Vpl& vpl = result.vpls[slot];
                EXPECT_FLOAT_EQ(vpl.power.x, albedo.x * e * 0.25f);
                EXPECT_FLOAT_EQ(vpl.power.y, albedo.y * 2 * e * 0.25f);
                EXPECT_EQ(vpl.power.z, 0.0f);
                EXPECT_EQ(vpl.depth, 1u);
                EXPECT_EQ(vpl.flags, NEARLIGHT_VPL_CLOSE);
                const auto [position, normal] = test::receiver_at(result.receivers, slot);
                EXPECT_EQ(vpl.position, position);
                EXPECT_EQ(vpl.normal, normal);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight
