// SPDX-License-Identifier: Apache-2.0
// Light sampling on the device (kernels/lib/light/): samples, their densities, and the combination with rays
// that find lights by themselves.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "host/base/random.h"
#include "host/reference/light_sampler.h"
#include "host/scene/environment_map.h"
#include "tests/stages/light_probes.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace light_probes;
using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class LightSamplingTest : public test::DeviceTest {};

enum class Sky { none, few_pixels, many_pixels };

/// A sky with a bright part and a sun. One of many pixels has blocks in which some pixels shine and others do
/// not, and blocks of all sizes at its edges.
EnvironmentLight make_sky(Sky sky) {
    const int width = sky == Sky::many_pixels ? 403 : 4;
    const int height = sky == Sky::many_pixels ? 131 : 2;
    EnvironmentLight environment{
        .width = width, .height = height, .radiance = {}, .to_world = rotation(1, 2, 3, 50)};
    environment.radiance.assign(static_cast<std::size_t>(width) * height, {0.1f, 0.1f, 0.2f});
    for (std::size_t i = 1; i < environment.radiance.size(); i += 97) {
        environment.radiance[i] = {5, 5, 4};
    }
    environment.is_interpolated = sky == Sky::many_pixels;
    environment.sun_direction = normalize(Vec3{1, -1, 2});
    environment.sun_half_angle = degrees_to_radians(4);
    environment.sun_radiance = {60, 50, 40};
    return environment;
}

/// Lamps above and beside the origin, some behind others, and a sky. The area lights are enough for a tree.
Scene lamps_and_sky(Sky sky) {
    Scene scene;
    const auto lamp = [&](Vec3 radiance) {
        Material material = lambertian({0.5f, 0.5f, 0.5f});
        material.emission = parameter_of(radiance);
        return add_material(scene, material);
    };
    add_quad(scene, {-0.5f, -0.5f, 2}, {0, 1, 0}, {1, 0, 0}, lamp({3, 6, 9}));         // above, faces down
    add_quad(scene, {1.5f, -1, 0.2f}, {0, 2, 0}, {0, 0, 1.5f}, lamp({1, 1, 0}));       // faces −X
    add_triangle(scene, {-3, 0, 3}, {-2, 1, 1}, {-3, 2, 0}, lamp({8, 4, 4}));          // to the left
    add_quad(scene, {-0.2f, -0.2f, -1}, {0, 0.4f, 0}, {0.4f, 0, 0}, lamp({9, 9, 9}));  // back side
    add_sphere_lamp(scene, {0.3f, -2.5f, 1.2f}, 0.6f, {4, 2, 7});
    add_cylinder_lamp(scene, {-1.2f, -0.5f, 0.5f}, 50, 0.2f, 1.5f, {5, 3, 4});
    if (sky != Sky::none) {
        scene.environment = make_sky(sky);
    }
    return scene;
}

/// Its pixels differ much, so that each of the four around a direction shows in what is between them.
TEST_F(LightSamplingTest, BetweenThePixelsOfAMapTheDeviceReadsWhatTheHostReads) {
    constexpr uint kCount = 2048;
    Scene scene;
    scene.environment = {.width = 5, .height = 4, .radiance = {}, .to_world = rotation(1, 2, 3, 50)};
    scene.environment.is_interpolated = true;
    Pcg32 random(11);
    for (int i = 0; i < 20; ++i) {
        scene.environment.radiance.push_back(10.0f *
                                             Vec3{random.uniform(), random.uniform(), random.uniform()});
    }
    const MapShape map{.width = 5, .height = 4, .is_interpolated = true};
    const Mat4 to_local = inverse(scene.environment.to_world);
    on_each_device([&](Device& device) {
        KernelProbe probe(device, light_probes::kSkyProbe + R"(
kernel void probe(SCENE_PARAMETERS, global float4* directions, global float4* radiances) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const float3 direction = square_to_cap(sample_2d(i, 0, 7), 2.0f);
    const LightReceiver at = even_receiver((float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f));
    directions[i] = (float4)(direction, 0.0f);
    radiances[i] = (float4)(sky_radiance(&scene, &at, direction), 0.0f);
}
)");
        const SceneOnDevice on_device(probe.device(), scene);
        Buffer<Float4> directions(probe.device(), kCount);
        Buffer<Float4> radiances(probe.device(), kCount);
        probe.kernel().launch(kCount, 8, on_device.buffers, directions, radiances);
        const std::vector<Float4> towards = directions.download();
        const std::vector<Float4> found = radiances.download();
        for (uint i = 0; i < kCount; ++i) {
            const Vec3 local =
                normalize(transform_vector(to_local, {towards[i][0], towards[i][1], towards[i][2]}));
            const Vec3 expected = map_radiance(map, local, [&](MapPixel pixel) {
                return scene.environment.radiance[pixel.row * 5 + pixel.column];
            });
            EXPECT_NEAR(found[i][0], expected.x, 2e-3f) << i;
            EXPECT_NEAR(found[i][2], expected.z, 2e-3f) << i;
        }
    });
}

TEST_F(LightSamplingTest, SamplesOfTheSunAreEvenOverItsDisc) {
    constexpr uint kCount = 4096;
    constexpr uint kRings = 4;  // of equal solid angle
    Scene scene = lamps_and_sky(Sky::few_pixels);
    scene.environment.sun_half_angle = degrees_to_radians(20);
    const double height = 1 - std::cos(degrees_to_radians(20.0));
    on_each_device([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, global float* heights) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    heights[i] = 1.0f - dot(sample_sun(&scene, sample_2d(i, 0, 7)), load3(scene.environment->sun_direction));
}
)");
        const SceneOnDevice on_device(probe.device(), scene);
        Buffer<float> heights(probe.device(), kCount);
        probe.kernel().launch(kCount, 8, on_device.buffers, heights);
        std::array<uint, kRings + 1> counts{};
        for (const float found : heights.download()) {
            ++counts[static_cast<uint>(std::clamp(found / height, 0.0, 1.0 + 1e-4) * kRings)];
        }
        for (uint ring = 0; ring < kRings; ++ring) {
            EXPECT_NEAR(counts[ring], kCount / kRings, 8) << "ring " << ring;
        }
    });
}

TEST_F(LightSamplingTest, SamplesHaveTheDensityThatRaysAreTold) {
    constexpr uint kCount = 4096;
    on_each_device([&](Device& device) {
        for (const Sky sky : {Sky::none, Sky::few_pixels, Sky::many_pixels}) {
            KernelProbe probe(device, kSampleProbe);
            const SceneOnDevice lamps(probe.device(), lamps_and_sky(sky));
            Buffer<Float4> out(probe.device(), kCount);
            probe.kernel().launch(kCount, 8, lamps.buffers, kOrigin, kUp, kNoLobe, kCount, out);
            uint visible = 0;
            uint different = 0;
            // Between pixels of few and of much light, rounding of the direction shows in the radiance.
            const float tolerance = sky == Sky::many_pixels ? 1e-2f : 1e-5f;
            for (const auto& [pdf, asked, ratio, is_visible] : out.download()) {
                visible += is_visible > 0 ? 1 : 0;
                const bool agrees = std::abs(pdf - asked) <= 1e-3f * pdf && std::abs(ratio - 1) <= tolerance;
                different += is_visible > 0 && !agrees ? 1 : 0;
            }
            EXPECT_GT(visible, kCount / 4);
            EXPECT_LE(different, kCount / 500) << "more than samples at an edge";
        }
    });
}

TEST_F(LightSamplingTest, DensitiesIntegrateToTheShareOfSamplesThatAreOfUse) {
    constexpr uint kCount = 1u << 18;
    on_each_device([&](Device& device) {
        for (const Sky sky : {Sky::none, Sky::few_pixels, Sky::many_pixels}) {
            KernelProbe densities(device, kDensityProbe);
            KernelProbe samples(device, kSampleProbe);
            const Scene scene = lamps_and_sky(sky);
            Buffer<float> density(densities.device(), kCount);
            densities.kernel().launch(kCount, 8, SceneOnDevice(densities.device(), scene).buffers, kOrigin,
                                      kUp, kNoLobe, kCount, density);
            double integral = 0;
            for (const float value : density.download()) {
                integral += 4 * double(kPi) * value / kCount;
            }
            Buffer<Float4> out(samples.device(), kCount);
            samples.kernel().launch(kCount, 8, SceneOnDevice(samples.device(), scene).buffers, kOrigin, kUp,
                                    kNoLobe, kCount, out);
            double visible = 0;
            for (const Float4& sample : out.download()) {
                visible += sample[3] / kCount;
            }
            EXPECT_NEAR(integral, visible, 0.01);
        }
    });
}

/// Any number of light samples and rays gives the same mean, that of the reference.
TEST_F(LightSamplingTest, CombinationsWithRaysAgreeWithTheReference) {
    constexpr uint kCount = 100'000;
    Scene scene = lamps_and_sky(Sky::many_pixels);
    add_point_light(scene, {0.3f, 0.2f, 1}, {0.5f, 0.5f, 0.5f});
    const EmbreeScene embree(scene);
    const LightSampler sampler(scene);
    Pcg32 random(8);
    double want = 0;
    constexpr int kSamples = 400'000;
    for (int s = 0; s < kSamples; ++s) {
        const LightRandom u{random.uniform(), {random.uniform(), random.uniform()}};
        const Point2 v{random.uniform(), random.uniform()};
        const Vec3 direction = sample_cosine_hemisphere(v);
        const BvhHit hit = embree.closest_hit({0, 0, 0}, direction, 0.0f, kInfinity);
        want += (sampler.sampled_irradiance(embree, {0, 0, 0}, {0, 0, 1}, u).y +
                 kPi * sampler.met_radiance(hit, {0, 0, 0}, direction, {0, 0, 1}).y) /
                kSamples;
    }
    on_each_device([&](Device& device) {
        KernelProbe probe(device, kCombinedProbe);
        const SceneOnDevice lamps(probe.device(), scene);
        Buffer<Float4> out(probe.device(), kCount);
        for (const auto& [light_samples, rays] : {std::pair{1u, 1u}, {3u, 1u}, {1u, 4u}}) {
            probe.kernel().launch(kCount, 8, lamps.buffers, kOrigin, kUp, light_samples, rays, kCount, out);
            double have = 0;
            for (const Float4& sum : out.download()) {
                have += sum[1] / kCount;
            }
            EXPECT_NEAR(have, want, 0.01 * want) << light_samples << " samples, " << rays << " rays";
        }
    });
}

}  // namespace
}  // namespace nearlight::core
