// SPDX-License-Identifier: Apache-2.0
// Spheres and cylinders that shine (kernels/lib/light/sphere.cl and cylinder.cl, host/reference/seen_sphere.h
// and seen_cylinder.h): the distribution of samples, their densities, particles, and the light that arrives.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>

#include "host/base/random.h"
#include "host/reference/light_sampler.h"
#include "host/reference/seen_cylinder.h"
#include "host/reference/seen_sphere.h"
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
using Float4 = std::array<float, 4>;

class RoundLightTest : public test::DeviceTest {};

constexpr uint kRoundSamples = 65536;
constexpr double kPiD = std::numbers::pi;

Scene one_lamp(Vec3 center, float radius) {
    Scene scene;
    add_sphere_lamp(scene, center, radius, {1, 2, 3});
    return scene;
}

/// Pearson's chi² of counts in cells that are equally likely, counted in standard deviations from its mean.
double deviation_from_even(std::span<const double> counts) {
    const auto cells = static_cast<double>(counts.size());
    const double expected = std::accumulate(counts.begin(), counts.end(), 0.0) / cells;
    double chi2 = 0;
    for (const double count : counts) {
        chi2 += (count - expected) * (count - expected) / expected;
    }
    return (chi2 - (cells - 1)) / std::sqrt(2.0 * cells);
}

/// Samples on a device of each scene's light, seen from the origin: directions, and the density that is asked
/// about a direction ÷ the one with which it was sampled. All are of one shape, "sphere" or "cylinder".
std::vector<std::vector<Float4>> samples_of(Device& device, const std::vector<Scene>& scenes,
                                            const std::string& shape) {
    const std::string source = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, global float4* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const uint4 words = random_uint4((uint4)(i, 1, 2, 3));
    const float2 u = (float2)(to_unit_float(words.x), to_unit_float(words.y));
    const RoundSample sample = SAMPLE(scene.emitters, (float3)(0.0f), u);
    const float asked = PDF(scene.emitters, (float3)(0.0f), sample.direction);
    out[i] = (float4)(sample.direction, asked > 0.0f ? asked / sample.pdf : 0.0f);
}
)";
    KernelProbe probe(device,
                      "#define SAMPLE sample_" + shape + "\n#define PDF " + shape + "_pdf\n" + source);
    Buffer<Float4> out(probe.device(), kRoundSamples);
    std::vector<std::vector<Float4>> samples;
    for (const Scene& scene : scenes) {
        const SceneOnDevice lamp(probe.device(), scene);
        probe.kernel().launch(kRoundSamples, 8, lamp.buffers, out);
        samples.push_back(out.download());
    }
    return samples;
}

/// The deviation of directions over cells of equal solid angle of the cone about `axis`.
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
    return deviation_from_even(counts);
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

TEST_F(RoundLightTest, ReferenceIsUniformOverTheCone) {
    for (const SphereView& view : kSphereViews) {
        const EmitterTable table = build_emitter_table(one_lamp(view.center, view.radius));
        ASSERT_EQ(table.emitters.size(), 1u);
        const SeenSphere seen(table.emitters[0], {0, 0, 0});
        EXPECT_NEAR(seen.solid_angle() / (2 * kPiD * (1 - cosine_of(view))), 1.0, 1e-4);
        Pcg32 random(5);
        std::vector<Vec3> directions;
        for (uint i = 0; i < kRoundSamples; ++i) {
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

TEST_F(RoundLightTest, DeviceIsUniformOverTheConeAndKnowsItsDensity) {
    std::vector<Scene> scenes;
    for (const SphereView& view : kSphereViews) {
        scenes.push_back(one_lamp(view.center, view.radius));
    }
    on_each_device([&](Device& device) {
        const std::vector<std::vector<Float4>> samples = samples_of(device, scenes, "sphere");
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            std::vector<Vec3> directions;
            uint outside = 0;
            for (const auto& [x, y, z, ratio] : samples[i]) {
                directions.push_back({x, y, z});
                outside += std::abs(ratio - 1.0f) < 1e-5f ? 0 : 1;  // devices round the two differently
            }
            EXPECT_LE(outside, kRoundSamples / 500) << "more than at the rim";
            const SphereView& view = kSphereViews[i];
            EXPECT_LT(deviation_over_cone(directions, normalize(view.center), cosine_of(view)), 4.5);
        }
    });
}

Scene one_tube(Vec3 end, double degrees, float radius, float length) {
    Scene scene;
    add_cylinder_lamp(scene, end, degrees, radius, length, {1, 2, 3});
    return scene;
}

/// A tube beside the origin, one that begins below it, one that is seen nearly from its end, and a far one.
std::vector<Scene> tubes() {
    return {one_tube({0.5f, 0.8f, 0.3f}, 60, 0.3f, 1.5f), one_tube({1, 0, -2}, 5, 0.8f, 6),
            one_tube({0.2f, 0.1f, 1}, 4, 0.1f, 9), one_tube({30, -40, 10}, 80, 0.2f, 0.5f)};
}

/// The deviation of directions from the origin over cells of the angle across the axis and the elevation.
double deviation_over_tube(const std::vector<Vec3>& directions, const RoundLamp& lamp) {
    constexpr int kCells = 8;
    std::array<double, kCells * kCells> counts{};
    const Vec3 axis = normalize(lamp.axis);
    const float low = dot(lamp.center, axis);
    const Vec3 to_axis = lamp.center - axis * low;
    const double distance = length(to_axis);
    const double half_angle = std::asin(lamp.radius / distance);
    for (const Vec3 direction : directions) {
        const double side = dot(direction, cross(axis, normalize(to_axis)));
        const double phi = std::atan2(side, dot(direction, normalize(to_axis)));
        const double past = std::min<double>(distance * std::abs(std::sin(phi)), lamp.radius);
        const double across = distance * std::cos(phi) - std::sqrt(lamp.radius * lamp.radius - past * past);
        const double first = std::atan2(low, across);
        const double last = std::atan2(low + length(lamp.axis), across);
        const double elevation = std::asin(std::clamp<double>(dot(direction, axis), -1, 1));
        const double u = 0.5 + 0.5 * phi / half_angle;
        const double v = (elevation - first) / (last - first);
        EXPECT_TRUE(u > -1e-2 && u < 1.01 && v > -1e-2 && v < 1.01) << u << ' ' << v;
        const int cell = std::clamp(static_cast<int>(u * kCells), 0, kCells - 1) * kCells +
                         std::clamp(static_cast<int>(v * kCells), 0, kCells - 1);
        counts[static_cast<std::size_t>(cell)] += 1;
    }
    return deviation_from_even(counts);
}

TEST_F(RoundLightTest, SamplesOfATubeAreUniformInBothAngles) {
    for (const Scene& scene : tubes()) {
        const EmitterTable table = build_emitter_table(scene);
        ASSERT_EQ(table.emitters.size(), 1u);
        const SeenCylinder seen(table.emitters[0], {0, 0, 0});
        ASSERT_TRUE(seen.is_seen());
        Pcg32 random(6);
        std::vector<Vec3> directions;
        for (uint i = 0; i < kRoundSamples; ++i) {
            const float x = random.uniform();
            directions.push_back(seen.sample({x, random.uniform()}));
        }
        EXPECT_LT(deviation_over_tube(directions, scene.round_lamps[0]), 4.5);
    }
    const std::vector<Scene> scenes = tubes();
    on_each_device([&](Device& device) {
        const std::vector<std::vector<Float4>> samples = samples_of(device, scenes, "cylinder");
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            std::vector<Vec3> directions;
            uint different = 0;
            for (const auto& [x, y, z, ratio] : samples[i]) {
                directions.push_back({x, y, z});
                different += std::abs(ratio - 1.0f) < 2e-3f ? 0 : 1;
            }
            EXPECT_LE(different, kRoundSamples / 200) << "more than at the rim";
            EXPECT_LT(deviation_over_tube(directions, scenes[i].round_lamps[0]), 4.5);
        }
    });
}

/// A direction that misses the shape has no density, although it may meet a triangle that stands for it.
TEST_F(RoundLightTest, DensitiesIntegrateToOne) {
    const std::string source = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, global float* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    out[i] = PDF(scene.emitters, (float3)(0.0f), square_to_cap(sample_2d(i, 0, 9), 2.0f));
}
)";
    const std::pair<std::string, Scene> cases[]{{"sphere", one_lamp({0.3f, -0.4f, 0.5f}, 0.5f)},
                                                {"cylinder", tubes()[0]}};
    on_each_device([&](Device& device) {
        for (const auto& [shape, scene] : cases) {
            KernelProbe probe(device, "#define PDF " + shape + "_pdf\n" + source);
            const SceneOnDevice lamp(probe.device(), scene);
            Buffer<float> out(probe.device(), kRoundSamples);
            probe.kernel().launch(kRoundSamples, 8, lamp.buffers, out);
            const std::vector<float> densities = out.download();
            const double sum = std::accumulate(densities.begin(), densities.end(), 0.0);
            EXPECT_NEAR(4 * kPiD * sum / kRoundSamples, 1.0, 0.01) << shape;
        }
    });
}

/// The share of all cosine-distributed directions about +Z in which a ray from the origin meets the outside
/// of the tube.
double share_of_tube(const RoundLamp& lamp) {
    constexpr int kTubeRays = 4'000'000;
    const Vec3 axis = normalize(lamp.axis);
    const Vec3 to_axis = lamp.center - axis * dot(lamp.center, axis);
    Pcg32 random(9);
    int met = 0;
    for (int i = 0; i < kTubeRays; ++i) {
        const float x = random.uniform();
        const Vec3 direction = sample_cosine_hemisphere({x, random.uniform()});
        const Vec3 flat = direction - axis * dot(direction, axis);
        const double a = dot(flat, flat);
        const double b = dot(flat, to_axis);
        const double c = dot(to_axis, to_axis) - lamp.radius * lamp.radius;
        const double root = b * b - a * c;
        if (root > 0 && b > 0) {
            const double t = (b - std::sqrt(root)) / a;
            const double along = t * dot(direction, axis) - dot(lamp.center, axis);
            met += along > 0 && along < length(lamp.axis) ? 1 : 0;
        }
    }
    return static_cast<double>(met) / kTubeRays;
}

/// By light samples, by rays, and by both.
void expect_irradiance(Device& device, const Scene& scene, double want) {
    for (const double have :
         test::direct_irradiance(device, scene, {0, 0, 0}, {0, 0, 1}, std::array{0u, 1u, 8u})) {
        EXPECT_NEAR(have, want, 0.006 * want);
    }
}

void expect_reference_irradiance(const Scene& scene, double want) {
    const EmbreeScene embree(scene);
    const LightSampler sampler(scene);
    Pcg32 random(8);
    double have = 0;
    for (uint i = 0; i < kRoundSamples; ++i) {
        const LightRandom u{random.uniform(), {random.uniform(), random.uniform()}};
        const Vec3 direction = sample_cosine_hemisphere({random.uniform(), random.uniform()});
        const BvhHit hit = embree.closest_hit({0, 0, 0}, direction, 0.0f, kInfinity);
        have += (sampler.sampled_irradiance(embree, {0, 0, 0}, {0, 0, 1}, u).y +
                 kPi * sampler.met_radiance(hit, {0, 0, 0}, direction, {0, 0, 1}).y) /
                kRoundSamples;
    }
    EXPECT_NEAR(have, want, 0.006 * want);
}

/// The irradiance of a sphere in full view is π·L·(r/d)²·cosθ; that of a tube is found by many rays.
TEST_F(RoundLightTest, LightThatArrivesIsThatOfTheShape) {
    constexpr Vec3 kCenter{0.6f, 0.3f, 0.9f};
    constexpr float kRadius = 0.4f;
    const double distance = static_cast<double>(length(kCenter));
    std::vector<std::pair<Scene, double>> cases;
    cases.emplace_back(one_lamp(kCenter, kRadius),
                       kPiD * 2 * std::pow(kRadius / distance, 2) * kCenter.z / distance);
    for (std::size_t i = 0; i < 3; ++i) {
        Scene tube = tubes()[i];
        const double want = 2 * kPiD * share_of_tube(tube.round_lamps[0]);
        cases.emplace_back(std::move(tube), want);
    }
    for (const auto& [scene, want] : cases) {
        expect_reference_irradiance(scene, want);
        on_each_device([&](Device& device) { expect_irradiance(device, scene, want); });
    }
}

/// What leaves a light: for each particle the squared distance of its line from the centre or the axis, in
/// squared radii, the flux, the component of its direction along `axis`, and how far along a cylinder it
/// starts, in lengths of it (0 for a sphere); −10 instead if it meets a triangle of its own light.
std::vector<Float4> particles(Device& device, const Scene& scene, Vec3 axis) {
    KernelProbe probe(device, R"(
#include "lib/light/emission.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, float4 axis, global float4* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const global Emitter* light = scene.emitters;
    const WalkAim aim = {{0.0f, 0.0f, 0.0f}, 0.0f};
    const EmittedParticle particle =
        emit_particle(&scene, &aim, 0.5f, sample_2d(i, 0, 3), sample_2d(i, 1, 3));
    const float3 from = particle.origin - load3(light->position);
    const float3 across = cross(particle.direction, load3(light->direction));
    const float3 past = light->type == NEARLIGHT_EMITTER_SPHERE ? cross(from, particle.direction)
                                                                 : (float3)(dot(from, normalize(across)), 0.0f, 0.0f);
    const SurfaceHit hit = trace_surface(&scene, particle.origin, particle.direction, INFINITY);
    const float along = light->type == NEARLIGHT_EMITTER_SPHERE
                            ? 0.0f : dot(from, load3(light->direction)) / light->length;
    out[i] = (float4)(dot(past, past) / (light->radius * light->radius), particle.flux.y,
                      dot(particle.direction, axis.xyz), hit.t >= 0.0f ? -10.0f : along);
}
)");
    const SceneOnDevice lamp(probe.device(), scene);
    Buffer<Float4> out(probe.device(), kRoundSamples);
    probe.kernel().launch(kRoundSamples, 8, lamp.buffers, Float4{axis.x, axis.y, axis.z, 0}, out);
    return out.download();
}

/// The lines of the light of an even sphere are spread evenly over its disc as seen along them, those of a
/// cylinder over its width; the elevation α of these has the density 2·cos²α/π.
TEST_F(RoundLightTest, ParticlesLeaveLikeTheLightOfTheShape) {
    struct Case {
        Scene scene;
        double flux, mean, mean_of_square, mean_of_elevation, mean_of_start, mean_of_squared_start;
    };
    constexpr float kRadius = 0.5f;
    const Case cases[] = {
        {one_lamp({3, -1, 2}, kRadius), 2 * kPiD * 4 * kPiD * 0.25, 0.5, 1.0 / 3, 1.0 / 3, 0, 0},
        {one_tube({3, -1, 2}, 0, kRadius, 4), 2 * kPiD * 2 * kPiD * 0.5 * 4, 1.0 / 3, 0.2, 0.25, 0.5,
         1.0 / 3}};
    on_each_device([&](Device& device) {
        for (const Case& shape : cases) {
            double mean = 0;
            double square = 0;
            double upwards = 0;
            double elevation = 0;
            double start = 0;
            double squared_start = 0;
            for (const auto& [share, flux, z, along] : particles(device, shape.scene, {0, 0, 1})) {
                mean += static_cast<double>(share) / kRoundSamples;
                square += static_cast<double>(share) * share / kRoundSamples;
                upwards += static_cast<double>(z) / kRoundSamples;
                elevation += static_cast<double>(z) * z / kRoundSamples;
                start += static_cast<double>(along) / kRoundSamples;
                squared_start += static_cast<double>(along) * along / kRoundSamples;
                ASSERT_GT(along, -1.0f) << "it meets its own light";
                ASSERT_NEAR(flux, shape.flux, 1e-5 * shape.flux);
            }
            EXPECT_NEAR(start, shape.mean_of_start, 0.006);
            EXPECT_NEAR(squared_start, shape.mean_of_squared_start, 0.006);
            EXPECT_NEAR(mean, shape.mean, 0.006);
            EXPECT_NEAR(square, shape.mean_of_square, 0.006);
            EXPECT_NEAR(upwards, 0.0, 0.01);
            EXPECT_NEAR(elevation, shape.mean_of_elevation, 0.006);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
