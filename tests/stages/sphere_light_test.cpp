// SPDX-License-Identifier: Apache-2.0
// Spheres that shine (kernels/lib/light/sphere.cl, host/reference/seen_sphere.h): samples that are uniform
// over the cone of directions, their densities, particles, and the light that arrives.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "host/base/random.h"
#include "host/reference/light_sampler.h"
#include "host/reference/seen_sphere.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;
using Float4 = std::array<float, 4>;

class SphereLightTest : public test::DeviceTest {};

constexpr uint kSphereSamples = 65536;
constexpr double kPiD = std::numbers::pi;

Scene one_lamp(Vec3 center, float radius) {
    Scene scene;
    add_sphere_lamp(scene, center, radius, {1, 2, 3});
    return scene;
}

/// Pearson's chi² of directions over cells of equal solid angle of the cone about `axis`, counted in standard
/// deviations from its mean.
double deviation_over_cone(const std::vector<Vec3>& directions, Vec3 axis, double cosine) {
    constexpr int kRings = 8;
    constexpr int kSectors = 8;
    std::array<double, kRings * kSectors> counts{};
    const Frame frame(axis);
    for (const Vec3 direction : directions) {
        const Vec3 local = frame.to_local(direction);
        const Vec3 chord = direction - axis;  // 1 − cosine is half its square, also for narrow cones
        const double part = 0.5 * static_cast<double>(dot(chord, chord)) / (1.0 - cosine);
        const double turn = 0.5 + std::atan2(local.y, local.x) / (2.0 * kPiD);
        EXPECT_LE(part, 1.001);
        const int ring = std::min(static_cast<int>(part * kRings), kRings - 1);
        const int sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
        counts[static_cast<std::size_t>(ring * kSectors + sector)] += 1;
    }
    const double expected = static_cast<double>(directions.size()) / counts.size();
    double chi2 = 0;
    for (const double count : counts) {
        chi2 += (count - expected) * (count - expected) / expected;
    }
    return (chi2 - (counts.size() - 1)) / std::sqrt(2.0 * counts.size());
}

struct SphereView {
    Vec3 center;
    float radius;
};
/// Spheres seen from the origin: near, at a middle distance, and as a narrow cone.
constexpr std::array<SphereView, 3> kSphereViews{
    SphereView{{0.2f, 0.3f, -1.0f}, 1.0f}, {{3, -4, 1}, 0.7f}, {{-20, 30, 40}, 0.05f}};

double cosine_of(const SphereView& view) {
    const double sine = static_cast<double>(view.radius) / static_cast<double>(length(view.center));
    return std::sqrt(1.0 - sine * sine);
}

TEST_F(SphereLightTest, ReferenceIsUniformOverTheCone) {
    for (const SphereView& view : kSphereViews) {
        const EmitterTable table = build_emitter_table(one_lamp(view.center, view.radius));
        ASSERT_EQ(table.emitters.size(), 1u);
        const SeenSphere seen(table.emitters[0], {0, 0, 0});
        EXPECT_NEAR(seen.solid_angle() / (2 * kPiD * (1 - cosine_of(view))), 1.0, 1e-4);
        Pcg32 random(5);
        std::vector<Vec3> directions;
        for (uint i = 0; i < kSphereSamples; ++i) {
            const float x = random.uniform();
            directions.push_back(seen.sample({x, random.uniform()}));
            EXPECT_NEAR(length(seen.entry(directions.back()) - view.center), table.emitters[0].outer_radius,
                        1e-4f * view.radius + 1e-5f * length(view.center));
        }
        EXPECT_LT(deviation_over_cone(directions, normalize(view.center), cosine_of(view)), 4.5);
    }
    const EmitterTable around = build_emitter_table(one_lamp({0, 0, 0.5f}, 1.0f));
    EXPECT_EQ(SeenSphere(around.emitters[0], {0, 0, 0}).solid_angle(), 0.0);
}

TEST_F(SphereLightTest, DeviceIsUniformOverTheConeAndKnowsItsDensity) {
    on_each_device([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, global float4* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const uint4 words = random_uint4((uint4)(i, 1, 2, 3));
    const float2 u = (float2)(to_unit_float(words.x), to_unit_float(words.y));
    const SphereSample sample = sample_sphere(scene.emitters, (float3)(0.0f), u);
    const float asked = sphere_pdf(scene.emitters, (float3)(0.0f), sample.direction);
    out[i] = (float4)(sample.direction, asked > 0.0f ? asked / sample.pdf : 0.0f);
}
)");
        Buffer<Float4> out(probe.device(), kSphereSamples);
        for (const SphereView& view : kSphereViews) {
            const SceneOnDevice lamp(probe.device(), one_lamp(view.center, view.radius));
            probe.kernel().launch(kSphereSamples, 8, lamp.buffers, out);
            std::vector<Vec3> directions;
            uint outside = 0;
            for (const auto& [x, y, z, ratio] : out.download()) {
                directions.push_back({x, y, z});
                outside += ratio == 1.0f ? 0 : 1;
            }
            EXPECT_LE(outside, kSphereSamples / 500) << "more than at the rim";
            EXPECT_LT(deviation_over_cone(directions, normalize(view.center), cosine_of(view)), 4.5);
        }
    });
}

/// The irradiance of a sphere in full view is π·L·(r/d)²·cosθ, by light samples, by rays, and by both.
TEST_F(SphereLightTest, LightThatArrivesIsThatOfTheClosedForm) {
    constexpr Vec3 kCenter{0.6f, 0.3f, 0.9f};
    constexpr float kRadius = 0.4f;
    const Scene scene = one_lamp(kCenter, kRadius);
    const double distance = static_cast<double>(length(kCenter));
    const double want = kPiD * 2 * std::pow(kRadius / distance, 2) * kCenter.z / distance;
    const EmbreeScene embree(scene);
    const LightSampler sampler(scene);
    Pcg32 random(8);
    double reference = 0;
    for (uint i = 0; i < kSphereSamples; ++i) {
        const LightRandom u{random.uniform(), {random.uniform(), random.uniform()}};
        const Vec3 direction = sample_cosine_hemisphere({random.uniform(), random.uniform()});
        const BvhHit hit = embree.closest_hit({0, 0, 0}, direction, 0.0f, kInfinity);
        reference += (sampler.sampled_irradiance(embree, {0, 0, 0}, {0, 0, 1}, u).y +
                      kPi * sampler.met_radiance(hit, {0, 0, 0}, direction, {0, 0, 1}).y) /
                     kSphereSamples;
    }
    EXPECT_NEAR(reference, want, 0.005 * want);
    on_each_device([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/receiver_path.cl"
kernel void probe(SCENE_PARAMETERS, uint rays, global float* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const ReceiverPoint at = {(float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), (float3)(0.0f), 0};
    const PathLimits limits = {1, 1, INFINITY, 1, rays, 0};
    out[i] = received_light(&scene, &at, &limits, random_uint4((uint4)(i, 5, 6, 7))).direct.y;
}
)");
        const SceneOnDevice lamp(probe.device(), scene);
        Buffer<float> out(probe.device(), kSphereSamples);
        for (const uint rays : {0u, 1u, 8u}) {
            probe.kernel().launch(kSphereSamples, 8, lamp.buffers, rays, out);
            double have = 0;
            for (const float light : out.download()) {
                have += light / kSphereSamples;
            }
            EXPECT_NEAR(have, want, 0.005 * want) << rays << " rays";
        }
    });
}

/// Particles carry all the flux, meet no triangle of their own sphere, and lie on lines that are spread
/// evenly over the sphere's disc as seen along them: their squared distance from the centre is uniform.
TEST_F(SphereLightTest, ParticlesLeaveLikeLightOfAnEvenSphere) {
    constexpr Vec3 kCenter{3, -1, 2};
    constexpr float kRadius = 0.5f;
    on_each_device([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/light/emission.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, global float4* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const EmittedParticle particle =
        emit_particle(&scene, (float2)(0.5f), sample_2d(i, 0, 3), sample_2d(i, 1, 3));
    const float3 past = cross(particle.origin - load3(scene.emitters->position), particle.direction);
    const SurfaceHit hit = trace_surface(&scene, particle.origin, particle.direction, INFINITY);
    out[i] = (float4)(dot(past, past), particle.flux.y, particle.direction.z, hit.t);
}
)");
        const SceneOnDevice lamp(probe.device(), one_lamp(kCenter, kRadius));
        Buffer<Float4> out(probe.device(), kSphereSamples);
        probe.kernel().launch(kSphereSamples, 8, lamp.buffers, out);
        double mean = 0, square = 0, upwards = 0;
        uint met = 0;
        for (const auto& [past, flux, z, t] : out.download()) {
            const double share = static_cast<double>(past) / (kRadius * kRadius);
            mean += share / kSphereSamples;
            square += share * share / kSphereSamples;
            upwards += static_cast<double>(z) / kSphereSamples;
            met += t >= 0 ? 1 : 0;
            ASSERT_NEAR(flux, 2 * kPiD * 4 * kPiD * kRadius * kRadius, 1e-3);
        }
        EXPECT_EQ(met, 0u);
        EXPECT_NEAR(mean, 0.5, 0.006);
        EXPECT_NEAR(square, 1.0 / 3, 0.006);
        EXPECT_NEAR(upwards, 0.0, 0.01);
    });
}

}  // namespace
}  // namespace nearlight::core
