// SPDX-License-Identifier: Apache-2.0
#include "host/reference/lobe.h"

#include <gtest/gtest.h>

#include "host/base/random.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

Surface flat_surface(const Material& material) {
    Surface surface;
    surface.position = {0, 0, 0};
    surface.geometric_normal = surface.shading_normal = {0, 0, 1};
    surface.material = &material;
    return surface;
}

LobeRandom next(Pcg32& random) {
    const float choice = random.uniform();
    const float x = random.uniform();
    return {choice, {x, random.uniform()}};
}

Vec3 towards(double cosine) {
    return {static_cast<float>(std::sqrt(1 - cosine * cosine)), 0, static_cast<float>(cosine)};
}

/// The integral ∫ D·G1(i)·G1(o)/(4 cosθo) dω of a GGX mirror, by quadrature from the definition of the half
/// vector.
double rough_mirror_albedo(double alpha, double cos_o) {
    constexpr int kSteps = 1500;
    const Vec3 o = towards(cos_o);
    const auto masking = [alpha](double c) {
        return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)));
    };
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double cos_i = (i + 0.5) / kSteps;
            const double phi = 2 * std::numbers::pi * (j + 0.5) / kSteps;
            const double sin_i = std::sqrt(1 - cos_i * cos_i);
            const Vec3 in{static_cast<float>(sin_i * std::cos(phi)),
                          static_cast<float>(sin_i * std::sin(phi)), static_cast<float>(cos_i)};
            const double h = normalize(in + o).z;
            const double t = h * h * (alpha * alpha - 1) + 1;
            const double d = alpha * alpha / (std::numbers::pi * t * t);
            sum += d * masking(cos_i) * masking(cos_o) / (4 * cos_o);
        }
    }
    return sum * 2 * std::numbers::pi / (double(kSteps) * kSteps);
}

TEST(Lobe, RoughMetalReflectsItsDirectionalAlbedo) {
    Material metal = small_scenes::lambertian({0, 0, 0});
    metal.lobe = NEARLIGHT_LOBE_CONDUCTOR;
    metal.eta = {0, 0, 0};
    metal.k = {1, 1, 1};
    for (const auto& [alpha, cosine] : {std::pair{0.2f, 0.9}, {0.5f, 0.5}, {0.5f, 0.15}}) {
        metal.roughness = alpha;
        Pcg32 random(3);
        double sum = 0;
        constexpr int kSamples = 200000;
        for (int i = 0; i < kSamples; ++i) {
            sum += sample_lobe(flat_surface(metal), towards(cosine), next(random)).weight.x;
        }
        EXPECT_NEAR(sum / kSamples, rough_mirror_albedo(alpha, cosine), 0.004) << alpha << ' ' << cosine;
    }
}

TEST(Lobe, SmoothMetalReflectsByFresnel) {
    // At normal incidence the reflectance is ((n − 1)² + k²) / ((n + 1)² + k²), here for a metal like copper.
    const Vec3 f = fresnel_conductor(1.0f, {0.2f, 0.9f, 1.1f}, {3.9f, 2.5f, 2.1f});
    EXPECT_NEAR(f.x, (0.64 + 15.21) / (1.44 + 15.21), 1e-4);
    EXPECT_NEAR(f.y, (0.01 + 6.25) / (3.61 + 6.25), 1e-4);
    EXPECT_NEAR(fresnel_conductor(0.0f, {0.2f, 0.9f, 1.1f}, {3.9f, 2.5f, 2.1f}).z, 1.0f, 2e-3f);
}

TEST(Lobe, GlassRefractsBySnellAndReflectsTotally) {
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1 / 1.5f), 0.04f, 1e-6f);
    EXPECT_EQ(fresnel_dielectric(0.5f, 1 / 1.5f), 1.0f);
    EXPECT_NEAR(fresnel_dielectric(std::cos(std::atan(1.5f)), 1.5f),
                0.5f * std::pow((1.5f * 1.5f - 1) / (1.5f * 1.5f + 1), 2.0f),
                1e-5f);  // at Brewster's angle no parallel light is reflected
    Material glass = small_scenes::lambertian({0, 0, 0});
    glass.lobe = NEARLIGHT_LOBE_DIELECTRIC;
    Surface surface = flat_surface(glass);
    const LobeSample in = sample_lobe(surface, towards(0.6), {0.999f, {}});
    EXPECT_NEAR(-in.direction.x, 0.8f / 1.5f, 1e-5f);
    EXPECT_LT(in.direction.z, 0.0f);
    surface.front = false;
    const LobeSample total = sample_lobe(surface, towards(0.6), {0.999f, {}});
    EXPECT_NEAR(total.direction.z, 0.6f, 1e-5f);
    EXPECT_NEAR(total.direction.x, -0.8f, 1e-5f);
}

TEST(Lobe, CoatTakesItsFresnelShareFromTheBase) {
    Material plastic = small_scenes::lambertian({0.5f, 0.5f, 0.5f});
    plastic.lobe = NEARLIGHT_LOBE_COAT;
    plastic.specular = {0.25f, 0.5f, 1};
    for (const float roughness : {0.0f, 0.3f}) {
        plastic.roughness = roughness;
        Pcg32 random(4);
        int base = 0;
        Vec3 reflected{0, 0, 0};
        constexpr int kSamples = 100000;
        for (int i = 0; i < kSamples; ++i) {
            const LobeSample lobe = sample_lobe(flat_surface(plastic), towards(0.3), next(random));
            base += lobe.is_base ? 1 : 0;
            reflected += lobe.is_base ? Vec3{0, 0, 0} : lobe.weight;
        }
        const float fresnel = fresnel_dielectric(0.3f, 1.5f);
        EXPECT_NEAR(base / double(kSamples), 1 - fresnel, 0.006);
        EXPECT_NEAR(reflected.x / reflected.z, 0.25f, 1e-3f);
        if (roughness == 0.0f) {
            EXPECT_NEAR(reflected.z / kSamples, fresnel, 0.006);
        }
    }
}

}  // namespace
}  // namespace nearlight::core
