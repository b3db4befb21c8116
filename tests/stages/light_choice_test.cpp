// SPDX-License-Identifier: Apache-2.0
// Which of many lamps is chosen for a receiver (kernels/lib/light/tree.cl).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "tests/stages/light_probes.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/received_light.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace light_probes;
using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class LightChoiceTest : public test::DeviceTest {};

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

TEST_F(LightChoiceTest, DensitiesOfTheLightTreeIntegrateToItsShareOfUse) {
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
TEST_F(LightChoiceTest, LightTreeHasTheSameMeanAndLessVariance) {
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
    const LightReceiver at = glossy_receiver(position.xyz, normal.xyz, viewer.xyz, 1.0f, viewer.w);
    const LightSample light = sample_light(&scene, &at, sample_2d(i, 0, 7), sample_2d(i, 1, 7));
    const float3 half_vector = normalize(viewer.xyz + light.direction);
    const float lobe = light.pdf > 0.0f ? pow(fmax(dot(half_vector, normal.xyz), 0.0f), 400.0f) : 0.0f;
    out[i] = lobe > 0.0f ? lobe * light.radiance.y / light.pdf : 0.0f;
}
)";

TEST_F(LightChoiceTest, AChoiceThatKnowsOfALobeHasTheSameMeanAndLessVariance) {
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

TEST_F(LightChoiceTest, RaysShareTheLightOfATreeWithLightSamples) {
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
