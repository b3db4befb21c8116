// SPDX-License-Identifier: Apache-2.0
// BSDFs on the device: samples against densities, energy, reciprocity, extreme parameters, and Mitsuba's
// values.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/stages/mitsuba_bsdf_values.h"
#include "tests/support/bsdf_materials.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace test;

class BsdfTest : public DeviceTest {};

// Cells of the sphere: even in z and in azimuth, each integrated by a grid of points.
constexpr int kRows = 40;
constexpr int kColumns = 40;
constexpr int kPoints = 11;
constexpr int kSamples = 100000;

struct Cells {
    std::vector<double> share = std::vector<double>(kRows * kColumns, 0.0);  ///< of all samples
    double value = 0.0;                                                      ///< ∫ BSDF |cosine|, green
};

Cells integrate(BsdfProbe& probe, const BsdfScene& scene, Vec3 wo, uint parts, uint mode) {
    std::vector<BsdfQuery> queries;
    for (int row = 0; row < kRows * kPoints; ++row) {
        const float z = 1.0f - (static_cast<float>(row) + 0.5f) * 2.0f / (kRows * kPoints);
        const float r = std::sqrt(1.0f - z * z);
        for (int column = 0; column < kColumns * kPoints; ++column) {
            const float phi = (static_cast<float>(column) + 0.5f) * 2.0f * kPi / (kColumns * kPoints) - kPi;
            queries.push_back(make_query(wo, {r * std::cos(phi), r * std::sin(phi), z}, parts, mode));
        }
    }
    const std::vector<BsdfAnswer> answers = probe.ask(scene, queries);
    const double solid_angle = 4.0 * std::numbers::pi / static_cast<double>(queries.size());
    Cells cells;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const std::size_t row = i / (kColumns * kPoints) / kPoints;
        const std::size_t column = i % (kColumns * kPoints) / kPoints;
        cells.share[row * kColumns + column] += answers[i].pdf * solid_angle;
        cells.value += answers[i].value.y * solid_angle;
    }
    return cells;
}

struct Drawn {
    std::vector<double> count = std::vector<double>(kRows * kColumns, 0.0);
    double lost = 0;             ///< samples of no direction
    double delta = 0;            ///< mirror images and the like
    double weight = 0;           ///< mean, green
    double weight_of_delta = 0;  ///< its part by mirror images and the like
};

Drawn draw(BsdfProbe& probe, const BsdfScene& scene, Vec3 wo, uint parts, uint mode) {
    Pcg32 random(7);
    std::vector<BsdfQuery> queries(kSamples, make_query(wo, {0, 0, 1}, parts, mode));
    for (BsdfQuery& query : queries) {
        draw_numbers(query, random);
    }
    Drawn drawn;
    for (const BsdfAnswer& answer : probe.ask(scene, queries)) {
        drawn.weight += answer.weight.y / kSamples;
        if (answer.is_delta != 0) {
            ++drawn.delta;
            drawn.weight_of_delta += answer.weight.y / kSamples;
        } else if (!(answer.sample_pdf > 0)) {
            ++drawn.lost;
        } else {
            const Vec3 wi = answer.wi;
            const auto row = std::clamp(static_cast<int>((1.0f - wi.z) * 0.5f * kRows), 0, kRows - 1);
            const float turn = (std::atan2(wi.y, wi.x) + kPi) / (2.0f * kPi);
            const auto column = std::clamp(static_cast<int>(turn * kColumns), 0, kColumns - 1);
            ++drawn.count[static_cast<std::size_t>(row * kColumns + column)];
        }
    }
    return drawn;
}

/// How many standard deviations a chi² statistic lies above its mean [Wilson & Hilferty 1931], where
/// densities may be wrong by the relative `error`.
double chi2_deviation(const Cells& cells, const Drawn& drawn, double error = 0) {
    double statistic = 0;
    double freedom = -1;
    double rest_expected = kSamples - drawn.delta;
    double rest_found = kSamples - drawn.delta;
    for (std::size_t i = 0; i < cells.share.size(); ++i) {
        const double expected = cells.share[i] * kSamples;
        if (expected > 50) {
            const double spread = expected + error * error * expected * expected;
            statistic += (drawn.count[i] - expected) * (drawn.count[i] - expected) / spread;
            freedom += 1;
            rest_expected -= expected;
            rest_found -= drawn.count[i];
        }
    }
    if (rest_expected > 50) {
        statistic += (rest_found - rest_expected) * (rest_found - rest_expected) / rest_expected;
        freedom += 1;
    }
    if (freedom < 1) {
        return 0;
    }
    const double variance = 2.0 / (9.0 * freedom);
    return (std::cbrt(statistic / freedom) - (1 - variance)) / std::sqrt(variance);
}

/// Whether a viewer behind the surface sees nothing.
bool is_opaque(const Material& material) {
    return material.model <= NEARLIGHT_BSDF_CONDUCTOR || material.model == NEARLIGHT_BSDF_PHONG ||
           material.model == NEARLIGHT_BSDF_WARD || (material.flags & NEARLIGHT_MATERIAL_LAYERED) != 0;
}

bool has_diffuse_part(const Material& material) {
    return material.reflectance.value.y > 0;
}

TEST_F(BsdfTest, SamplesFollowTheirDensityAndGiveTheIntegral) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const auto& [name, material] : make_materials()) {
            const BsdfScene scene = scene_of(material);
            for (const float degrees : {25.0f, 70.0f, 150.0f, 112.0f}) {
                if (degrees > 90 && is_opaque(material)) {
                    continue;
                }
                for (const uint parts : {kPartS, kBothParts}) {
                    if (parts == kBothParts && !has_diffuse_part(material)) {
                        continue;
                    }
                    SCOPED_TRACE(name + " seen at " + std::to_string(degrees) + ", parts " +
                                 std::to_string(parts));
                    const Vec3 wo = direction_at(degrees);
                    const Cells cells = integrate(probe, scene, wo, parts, kRadiance);
                    const Drawn drawn = draw(probe, scene, wo, parts, kRadiance);
                    // Smith's masking of Beckmann's facets is a fit (Walter et al. 2007).
                    const double error = material.flags & NEARLIGHT_MATERIAL_BECKMANN ? 0.0035 : 0;
                    EXPECT_LT(chi2_deviation(cells, drawn, error), 4.5);
                    EXPECT_NEAR(drawn.weight - drawn.weight_of_delta, cells.value,
                                0.012 * cells.value + 1e-4);
                }
            }
        }
    });
}

/// The test above must find a density that is a little wrong.
TEST_F(BsdfTest, ChiSquaredFindsAWrongDensity) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        const Vec3 wo = direction_at(40);
        const BsdfScene right = scene_of(make_metal(0.3f, 0.3f, 0, {0, 0, 0}, {1, 1, 1}));
        const BsdfScene wrong = scene_of(make_metal(0.33f, 0.3f, 0, {0, 0, 0}, {1, 1, 1}));
        const Drawn drawn = draw(probe, right, wo, kPartS, kRadiance);
        EXPECT_LT(chi2_deviation(integrate(probe, right, wo, kPartS, kRadiance), drawn), 4.5);
        EXPECT_GT(chi2_deviation(integrate(probe, wrong, wo, kPartS, kRadiance), drawn), 6.0);
    });
}

/// A white surface in a white furnace; flux that passes a boundary keeps its energy.
TEST_F(BsdfTest, NoSurfaceMakesLight) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const auto& [name, material] : make_materials()) {
            if (!name.starts_with("white")) {
                continue;
            }
            for (const float degrees : {0.0f, 30.0f, 60.0f, 80.0f, 89.0f, 100.0f, 150.0f, 180.0f}) {
                if (degrees > 90 && is_opaque(material)) {
                    continue;
                }
                SCOPED_TRACE(name + " seen at " + std::to_string(degrees));
                const double weight =
                    draw(probe, scene_of(material), direction_at(degrees), kBothParts, kFlux).weight;
                EXPECT_LT(weight, 1.002);
                const bool rough = material.roughness.value.x > 0.2f;
                EXPECT_GT(weight, rough ? 0.3 : (name == "white plastic" ? 0.93 : 0.8));
                if (material.roughness.value.x == 0 && !is_opaque(material)) {
                    EXPECT_NEAR(weight, 1, 1e-5);
                }
            }
        }
    });
}

/// What light brings to a viewer is the same from either end: radiance · cosθ of the viewer = flux · cosθ of
/// the light.
TEST_F(BsdfTest, BothEndsOfAPathAgree) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const auto& [name, material] : make_materials()) {
            SCOPED_TRACE(name);
            Pcg32 random(11);
            std::vector<BsdfQuery> radiance;
            std::vector<BsdfQuery> flux;
            for (int i = 0; i < 3000; ++i) {
                const Vec3 viewer = random_direction(random);
                const Vec3 light =
                    i % 2 == 0 ? random_direction(random)
                               : normalize(random_direction(random) * 0.3f +
                                           Vec3{-viewer.x, -viewer.y, i % 4 == 1 ? viewer.z : -viewer.z});
                radiance.push_back(make_query(viewer, light, kBothParts, kRadiance));
                flux.push_back(make_query(light, viewer, kBothParts, kFlux));
            }
            const std::vector<BsdfAnswer> seen = probe.ask(scene_of(material), radiance);
            const std::vector<BsdfAnswer> sent = probe.ask(scene_of(material), flux);
            int lit = 0;
            for (std::size_t i = 0; i < seen.size(); ++i) {
                const float a = seen[i].value.x * std::abs(radiance[i].wo.z);
                const float b = sent[i].value.x * std::abs(radiance[i].wi.z);
                // Near the critical angle, 1 − F loses digits.
                EXPECT_NEAR(a, b, 0.004f * std::max(a, b) + 2e-5f) << i;
                lit += a > 0 ? 1 : 0;
            }
            const bool smooth = material.roughness.value.x == 0 &&
                                name.find("plastic") == std::string::npos && name != "diffuse";
            EXPECT_EQ(lit > 100, !smooth);
        }
    });
}

TEST_F(BsdfTest, ExtremesAreFinite) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (auto [name, material] : make_materials()) {
            SCOPED_TRACE(name);
            Pcg32 random(5);
            for (const float alpha : {0.0f, 1e-4f, 1e-3f, 1.1e-3f, 1.0f}) {
                for (const float eta : {1.0001f, 1.5f, 3.0f}) {
                    material.roughness = constant(alpha);
                    material.eta = {eta, eta, eta};
                    std::vector<BsdfQuery> queries;
                    for (const float cosine :
                         {1.0f, 1e-2f, 1e-4f, 1e-7f, 1e-20f, 0.0f, -1e-20f, -1e-6f, -1.0f}) {
                        const float r = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
                        for (int i = 0; i < 64; ++i) {
                            const Vec3 wo{0.6f * r, 0.8f * r, cosine};
                            const Vec3 wi = i < 8 ? Vec3{-wo.x, -wo.y, i % 2 == 0 ? wo.z : -wo.z}
                                                  : random_direction(random);
                            queries.push_back(make_query(wo, wi, kBothParts, i % 2));
                            draw_numbers(queries.back(), random);
                            if (i % 8 == 0) {
                                queries.back().v[0] = i % 16 == 0 ? 0.0f : 1.0f - 0x1p-24f;
                            }
                        }
                    }
                    for (const BsdfAnswer& answer : probe.ask(scene_of(material), queries)) {
                        const float sum = answer.value.x + answer.value.y + answer.value.z + answer.pdf +
                                          answer.wi.x + answer.wi.y + answer.wi.z + answer.weight.x +
                                          answer.weight.y + answer.weight.z + answer.albedo.x + answer.eta;
                        ASSERT_TRUE(std::isfinite(sum)) << "alpha " << alpha << ", eta " << eta;
                        ASSERT_GE(std::min({answer.value.x, answer.value.y, answer.value.z, answer.pdf,
                                            answer.sample_pdf}),
                                  0.0f);
                        // Fake subsurface scattering grows without bound where viewer and light are both
                        // grazing.
                        if (material.flatness.value.x == 0) {
                            ASSERT_LT(answer.weight.y, 60.0f) << "alpha " << alpha << ", eta " << eta;
                        }
                    }
                }
            }
        }
    });
}

TEST_F(BsdfTest, AlbedoIsNearTheIntegral) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const auto& [name, material] : make_materials()) {
            for (const float degrees : {10.0f, 60.0f, 160.0f}) {
                if (degrees > 90 && is_opaque(material)) {
                    continue;
                }
                SCOPED_TRACE(name + " seen at " + std::to_string(degrees));
                const BsdfScene scene = scene_of(material);
                const Vec3 wo = direction_at(degrees);
                const float albedo = probe.ask(scene, make_query(wo, wo, kBothParts)).albedo.y;
                const double exact = draw(probe, scene, wo, kBothParts, kFlux).weight;
                // The estimate is coarse where leaning facets reflect all or not, as beyond a critical angle.
                const double slack = material.eta.x < 1 ? 0.5 : 0.3;
                EXPECT_NEAR(albedo, exact, material.roughness.value.x == 0 ? 0.03 : slack);
            }
        }
    });
}

/// An estimate of nothing ends paths, so it must not stand for a little.
TEST_F(BsdfTest, AlbedoIsNothingOnlyWhereAllIs) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        for (const auto& [name, material] : make_materials()) {
            for (const bool reflects : {false, true}) {
                SCOPED_TRACE(name + (reflects ? ", reflection alone" : ", transmission alone"));
                Material dark = material;
                (reflects ? dark.transmission : dark.specular) = constant(0.0f);
                Pcg32 random(11);
                std::vector<BsdfQuery> queries;
                for (int i = 0; i < 1000; ++i) {
                    queries.push_back(
                        make_query(random_direction(random), random_direction(random), kPartS, i % 2));
                }
                for (const BsdfAnswer& answer : probe.ask(scene_of(dark), queries)) {
                    EXPECT_TRUE(max_component(answer.value) <= 0 || max_component(answer.albedo) > 0);
                }
            }
        }
    });
}

/// Peaks and one more value of the lobes beside a Lambertian base, for a viewer at 60°.
TEST_F(BsdfTest, LobesBesideABaseAreTheirFormulas) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        const float sine = std::sqrt(0.75f);
        const Vec3 wo{sine, 0, 0.5f};
        const Vec3 mirrored{-sine, 0, 0.5f};
        const Vec3 up{0, 0, 1};
        const auto expect = [&](const Material& material, Vec3 from, Vec3 to, double lobe) {
            const BsdfAnswer answer = probe.ask(scene_of(material), make_query(from, to, kPartS));
            EXPECT_NEAR(answer.value.x, 0.3 * lobe * to.z, 2e-5 * (1.0 + lobe));
        };
        // The exponent 48 and the exponent 0.
        const Material narrow = make_lobe(NEARLIGHT_BSDF_PHONG, 0.2f, 0.2f);
        expect(narrow, wo, mirrored, 50 / (2 * std::numbers::pi));
        expect(narrow, wo, up, 50 / (2 * std::numbers::pi) * std::pow(0.5, 48));
        expect(make_lobe(NEARLIGHT_BSDF_PHONG, 1, 1), wo, up, 2 / (2 * std::numbers::pi));
        // The half vector is the normal, where the exponential is 1, and then lies at 30° to it along x.
        const Material ward = make_lobe(NEARLIGHT_BSDF_WARD, 0.4f, 0.2f);
        const double scale = 1 / (4 * std::numbers::pi * 0.4 * 0.2);
        expect(ward, up, up, scale);
        expect(ward, wo, mirrored, scale / 0.25);
        expect(ward, wo, up, scale * std::exp(-1 / 3.0 / 0.16) / std::pow(0.75, 3));
    });
}

TEST_F(BsdfTest, ValuesAreMitsubas) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        const std::map<std::string, Material> materials = make_materials();
        for (const MitsubaBsdfValue& row : kMitsubaBsdfValues) {
            SCOPED_TRACE(row.material);
            const uint parts = std::string(row.material) == "rough_plastic" ? kPartS : kBothParts;
            const BsdfAnswer answer =
                probe.ask(scene_of(materials.at(row.material)), make_query(row.wo, row.wi, parts));
            const auto near = [](float found, float expected) {
                EXPECT_NEAR(found, expected, 1e-4f * expected + 1e-7f);
            };
            near(answer.value.x, row.value.x);
            near(answer.value.y, row.value.y);
            near(answer.value.z, row.value.z);
            if (row.pdf >= 0) {
                near(answer.pdf, row.pdf);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
