// SPDX-License-Identifier: Apache-2.0
// Light sampling on the device (kernels/lib/light/): samples, their densities, and the combination with rays
// that find lights by themselves.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "host/base/random.h"
#include "host/reference/light_sampler.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/received_light.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class LightSamplingTest : public test::DeviceTest {};

/// Takes samples at the receiver, which has a lobe of the roughness viewer.w if that is not 0, and asks for
/// the density of the direction of each by tracing it. `out` gets (density of the sample, density by
/// light_pdf, radiance found ÷ radiance of the sample, 1 if visible).
constexpr const char* kSampleProbe = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, float4 viewer, uint count, global float4* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 x = position.xyz;
    const float3 n = normal.xyz;
    LightReceiver at = even_receiver(x, n);
    at.viewer = viewer.xyz;
    at.alpha = viewer.w;
    at.gloss = at.alpha > 0.0f ? 0.9f : 0.0f;
    const LightSample light = sample_light(&scene, &at, sample_2d(i, 0, 7), sample_2d(i, 1, 7));
    const SurfaceHit hit = trace_surface(&scene, x, light.direction, INFINITY);
    const float3 found = hit.t < 0.0f ? environment_radiance(&scene, light.direction)
                                      : emitted_radiance(&scene, &hit);
    out[i] = (float4)(light.pdf, light_pdf(&scene, &at, light.direction, &hit), found.y / light_radiance(&scene, &light).y,
                      may_shine(&light) ? (float)light_is_visible(&scene, x, &light) : 0.0f);
}
)";

/// Density by light_pdf of directions that are uniform over the sphere, for such a receiver.
constexpr const char* kDensityProbe = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, float4 viewer, uint count, global float* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 direction = square_to_cone(sample_2d(i, 0, 9), -1.0f);
    const SurfaceHit hit = trace_surface(&scene, position.xyz, direction, INFINITY);
    LightReceiver at = even_receiver(position.xyz, normal.xyz);
    at.viewer = viewer.xyz;
    at.alpha = viewer.w;
    at.gloss = at.alpha > 0.0f ? 0.9f : 0.0f;
    out[i] = light_pdf(&scene, &at, direction, &hit);
}
)";

/// Irradiance by light samples combined with cosine-distributed rays.
constexpr const char* kCombinedProbe = R"(
#include "lib/receiver_path.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, uint light_samples, uint rays, uint count,
                  global float4* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 x = position.xyz;
    const float3 n = normal.xyz;
    const ReceiverPoint at = {x, n, (float3)(0.0f), 0};
    const LightReceiver receiver = even_receiver(x, n);
    float3 sum = sampled_direct_light(&scene, &at, light_samples, rays, 0, 0, 0, i);
    for (uint ray = 0; ray < rays; ++ray) {
        const float3 direction = to_world_frame(square_to_cosine_hemisphere(sample_2d(ray, 5, i)), n);
        const SurfaceHit hit = trace_surface(&scene, x, direction, INFINITY);
        const float3 found = hit.t < 0.0f ? environment_radiance(&scene, direction)
                                          : emitted_radiance(&scene, &hit);
        const float own = (float)rays * dot(n, direction) * M_1_PI_F;
        const float other = (float)light_samples * light_pdf(&scene, &receiver, direction, &hit);
        sum += found * (M_PI_F / (float)rays * own / (own + other));
    }
    out[i] = (float4)(sum, 0.0f);
}
)";

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

/// A hall of 40 × 10 × 3 m with 200 lamps below its ceiling, octahedra of 8 triangles, some much brighter
/// than others.
Scene hall_of_lamps() {
    Scene scene;
    const uint plaster = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    add_quad(scene, {-20, -5, 0}, {40, 0, 0}, {0, 10, 0}, plaster);
    std::array<uint, 3> lamps{};
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(Vec3{1, 0.9f, 0.8f} * (10.0f * static_cast<float>(1 + 2 * i)));
        lamps[i] = add_material(scene, lamp);
    }
    for (int i = 0; i < 200; ++i) {
        const Vec3 c{-19.5f + 2.0f * static_cast<float>(i % 20), -4.5f + static_cast<float>(i / 20), 2.7f};
        constexpr float r = 0.08f;
        for (const float x : {-r, r}) {
            for (const float y : {-r, r}) {
                for (const float z : {-r, r}) {
                    const bool swaps = x * y * z < 0;
                    const Vec3 a = c + Vec3{x, 0, 0};
                    const Vec3 b = c + Vec3{0, y, 0};
                    add_triangle(scene, swaps ? b : a, swaps ? a : b, c + Vec3{0, 0, z},
                                 lamps[static_cast<std::size_t>(i) % lamps.size()]);
                }
            }
        }
    }
    return scene;
}

/// The same scene on the device without its tree of lights.
void leave_out_tree(SceneOnDevice& scene) {
    SceneInfo info = scene.buffers.host_info;
    info.tree_end = info.tree_first;
    scene.buffers.info.upload(std::span(&info, 1));
}

using Float4 = std::array<float, 4>;
constexpr Float4 kOrigin{0, 0, 0, 0};
constexpr Float4 kUp{0, 0, 1, 0};
constexpr Float4 kNoLobe{0, 0, 1, 0};

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

TEST_F(LightSamplingTest, DensitiesOfTheLightTreeIntegrateToItsShareOfUse) {
    constexpr uint kCount = 1u << 19;
    on_each_device([&](Device& device) {
        KernelProbe densities(device, kDensityProbe);
        KernelProbe samples(device, kSampleProbe);
        const SceneOnDevice hall(densities.device(), hall_of_lamps());
        const SceneOnDevice same_hall(samples.device(), hall_of_lamps());
        ASSERT_GT(hall.buffers.host_info.tree_end, 0u);
        struct Receiver {
            Float4 normal, viewer;
        };
        for (const auto& [normal, viewer] :
             {Receiver{kUp, kNoLobe}, Receiver{{0, 0, 0, 0}, kNoLobe}, Receiver{{0.8f, 0, -0.6f, 0}, kNoLobe},
              Receiver{kUp, {-0.6f, 0, 0.8f, 0.3f}}, Receiver{kUp, {0.98f, 0, 0.199f, 0.6f}}}) {
            const Float4 place{3.1f, 0.4f, 2.5f, 0};
            Buffer<float> density(densities.device(), kCount);
            densities.kernel().launch(kCount, 8, hall.buffers, place, normal, viewer, kCount, density);
            double integral = 0;
            double squares = 0;
            for (const float value : density.download()) {
                const double term = 4 * double(kPi) * value;
                integral += term / kCount;
                squares += term * term / kCount;
            }
            const double deviation = std::sqrt((squares - integral * integral) / kCount);
            Buffer<Float4> out(samples.device(), kCount);
            samples.kernel().launch(kCount, 8, same_hall.buffers, place, normal, viewer, kCount, out);
            double visible = 0;
            uint different = 0;
            for (const auto& [pdf, asked, ratio, is_visible] : out.download()) {
                visible += is_visible / kCount;
                different += is_visible > 0 && std::abs(pdf - asked) > 2e-3f * pdf ? 1 : 0;
            }
            EXPECT_GT(visible, 0.3);
            EXPECT_LT(deviation, 0.04);
            EXPECT_NEAR(integral, visible, 4 * deviation);
            EXPECT_LE(different, kCount / 500) << "more than samples at an edge";
        }
    });
}

/// Means and variances of one-sample estimates on the floor, with the tree and with the table of powers.
TEST_F(LightSamplingTest, LightTreeHasTheSameMeanAndLessVariance) {
    constexpr uint kCount = 1u << 16;
    on_each_device([&](Device& device) {
        KernelProbe probe(device, kCombinedProbe);
        SceneOnDevice with_tree(probe.device(), hall_of_lamps());
        SceneOnDevice by_power(probe.device(), hall_of_lamps());
        leave_out_tree(by_power);
        Buffer<Float4> out(probe.device(), kCount);
        for (const Float4& place :
             {Float4{0.3f, 0.2f, 0.01f, 0}, {-15, 3, 0.01f, 0}, {19, -4.8f, 0.01f, 0}}) {
            const auto moments = [&](const SceneOnDevice& hall, const Float4& normal) {
                probe.kernel().launch(kCount, 8, hall.buffers, place, normal, 1u, 0u, kCount, out);
                double sum = 0;
                double squares = 0;
                for (const Float4& sample : out.download()) {
                    sum += sample[1] / kCount;
                    squares += double(sample[1]) * sample[1] / kCount;
                }
                return std::pair{sum, squares - sum * sum};
            };
            for (const Float4& normal : {kUp, Float4{0.6f, 0, 0.8f, 0}}) {
                const auto [mean, variance] = moments(with_tree, normal);
                const auto [power_mean, power_variance] = moments(by_power, normal);
                EXPECT_NEAR(mean, power_mean, 5 * std::sqrt((variance + power_variance) / kCount));
                EXPECT_LT(10 * variance, power_variance);
            }
        }
    });
}

/// One-sample estimates of what a narrow lobe reflects of the lamps, if the choice knows of it or not.
constexpr const char* kLobeProbe = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, float4 viewer, uint count, global float* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    LightReceiver at = even_receiver(position.xyz, normal.xyz);
    at.viewer = viewer.xyz;
    at.alpha = viewer.w;
    at.gloss = at.alpha > 0.0f ? 0.9f : 0.0f;
    const LightSample light = sample_light(&scene, &at, sample_2d(i, 0, 7), sample_2d(i, 1, 7));
    const float3 half_vector = normalize(viewer.xyz + light.direction);
    const float lobe = light.pdf > 0.0f ? pow(fmax(dot(half_vector, normal.xyz), 0.0f), 400.0f) : 0.0f;
    out[i] = lobe > 0.0f ? lobe * light.radiance.y / light.pdf : 0.0f;
}
)";

TEST_F(LightSamplingTest, AChoiceThatKnowsOfALobeHasTheSameMeanAndLessVariance) {
    constexpr uint kCount = 1u << 16;
    on_each_device([&](Device& device) {
        KernelProbe probe(device, kLobeProbe);
        const SceneOnDevice hall(probe.device(), hall_of_lamps());
        Buffer<float> out(probe.device(), kCount);
        const auto moments = [&](const Float4& viewer) {
            probe.kernel().launch(kCount, 8, hall.buffers, Float4{0.3f, 0.2f, 0.01f, 0}, kUp, viewer, kCount,
                                  out);
            double sum = 0;
            double squares = 0;
            for (const float estimate : out.download()) {
                sum += estimate / kCount;
                squares += double(estimate) * estimate / kCount;
            }
            return std::pair{sum, squares - sum * sum};
        };
        for (const Float4& viewer : {Float4{0, 0.6f, 0.8f, 0}, Float4{0.8f, 0, 0.6f, 0}}) {
            Float4 with_lobe = viewer;
            with_lobe[3] = 0.1f;
            const auto [mean, variance] = moments(with_lobe);
            const auto [even_mean, even_variance] = moments(viewer);
            EXPECT_NEAR(mean, even_mean, 5 * std::sqrt((variance + even_variance) / kCount));
            EXPECT_LT(3 * variance, even_variance);
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

TEST_F(LightSamplingTest, RaysShareTheLightOfATreeWithLightSamples) {
    const Scene hall = hall_of_lamps();
    on_each_ray_tree([&](Device& device) {
        const std::vector<double> light = test::direct_irradiance(device, hall, {0.5f, 0.5f, 2.2f}, {0, 0, 1},
                                                                  std::array{0u, 1u, 8u});  // below a lamp
        EXPECT_NEAR(light[1], light[0], 0.01 * light[0]);
        EXPECT_NEAR(light[2], light[0], 0.01 * light[0]);
    });
}

}  // namespace
}  // namespace nearlight::core
