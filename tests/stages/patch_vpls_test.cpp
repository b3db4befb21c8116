// SPDX-License-Identifier: Apache-2.0
#include "host/stages/patch_vpls.h"

#include "host/base/random.h"
#include "host/scene/camera.h"
#include "host/scene/ray_epsilon.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

class PatchVplsTest : public test::DeviceTest {};

constexpr uint kSamples = 100;
constexpr std::size_t kSlots = 2 * kSamples;
constexpr float kAreaPerSample = 0.25f;

/// A one-sided wall (triangles 0 and 1) and a two-sided one (2 and 3), seen from the origin.
Scene two_walls() {
    Scene scene;
    const uint one = add_material(scene, lambertian({0.5f, 0.25f, 0.125f}));
    const uint two = add_two_sided(scene, lambertian({0.2f, 0.4f, 0.8f}));
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

struct PatchResult {
    std::vector<Vpl> vpls;
    std::vector<uint> flags;
};

PatchResult make_patches(Device& device, const Scene& scene, bool whole_triangles) {
    const SceneOnDevice on_device(device, scene);
    const CloseRange range = make_close_range(make_camera(scene.camera, 64, 64), 2.6f);
    CloseRegion region;
    region.range = Buffer<CloseRange>(device, std::span(&range, 1));
    region.whole_triangles = whole_triangles;
    const Buffer<SurfaceSample> samples(device, samples_on(scene));
    Buffer<Vpl> vpls(device, kSlots);
    Buffer<uint> flags(device, std::vector<uint>(kSlots + 1, 7));
    PatchVpls(device).run(on_device.buffers, samples, kSamples, region, kAreaPerSample, vpls, flags);
    const std::vector<uint> found = flags.download();
    EXPECT_EQ(found.back(), 7u) << "written beyond the last slot";
    return {vpls.download(), found};
}

/// The close range of a camera with half a field of view of 30° and a range of 2.6 m.
bool in_region(Vec3 p) {
    const float edge = p.z * std::tan(degrees_to_radians(30));
    return std::abs(p.x) <= edge && std::abs(p.y) <= edge && length(p) < 2.6f;
}

TEST_F(PatchVplsTest, SidesThatReflectInTheRegionBecomeVpls) {
    const Scene scene = two_walls();
    const std::vector<SurfaceSample> samples = samples_on(scene);
    on_each_device([&](Device& device) {
        for (const bool whole : {true, false}) {
            const PatchResult result = make_patches(device, scene, whole);
            std::size_t present = 0;
            for (std::size_t i = 0; i < kSlots; ++i) {
                const SurfaceSample& sample = samples[i / 2];
                const bool front = i % 2 == 0;
                const bool expected =
                    (whole || in_region(sample.position)) && (front || sample.triangle >= 2);
                ASSERT_EQ(result.flags[i], expected ? 1u : 0u) << "slot " << i;
                if (expected) {
                    const Vec3 side = front ? sample.normal : -sample.normal;
                    const Vpl& vpl = result.vpls[i];
                    EXPECT_EQ(vpl.normal, side);
                    const float off = triangle_stand_off(scene, sample.triangle, bounds(scene).size());
                    EXPECT_NEAR(length(vpl.position - (sample.position + side * off)), 0.0f, 1e-6f);
                    EXPECT_EQ(vpl.depth, 0u);
                    EXPECT_EQ(vpl.flags, NEARLIGHT_VPL_CLOSE);
                    ++present;
                }
            }
            EXPECT_GT(present, 10u);
        }
    });
}

TEST_F(PatchVplsTest, PowerIsAlbedoTimesArea) {
    const Scene scene = two_walls();
    const std::vector<SurfaceSample> samples = samples_on(scene);
    on_each_device([&](Device& device) {
        const PatchResult result = make_patches(device, scene, true);
        for (std::size_t i = 0; i < kSlots; ++i) {
            if (result.flags[i] != 0) {
                // The two-sided material is the one after the Lambertian one that it shows on both sides.
                const Vec3 albedo = scene.materials[samples[i / 2].triangle / 2].reflectance.value;
                EXPECT_EQ(result.vpls[i].power, albedo * kAreaPerSample);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
