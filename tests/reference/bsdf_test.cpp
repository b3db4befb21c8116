// SPDX-License-Identifier: Apache-2.0
// Every model by itself: samples against densities, reciprocity, energy, and albedos against quadrature.
#include <gtest/gtest.h>

#include <vector>

#include "tests/reference/bsdf_cases.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr double kCosines[] = {0.95, 0.6, 0.25, -0.3, -0.9};

/// Counts of directions in cells of equal solid angle.
class SphereHistogram {
  public:
    static constexpr int kRows = 40, kColumns = 40;
    std::vector<double> cells = std::vector<double>(std::size_t{kRows} * kColumns);

    void add(Vec3d w) {
        const double turn = std::atan2(w.y, w.x) / (2 * std::numbers::pi);
        const int row = std::min(static_cast<int>((w.z + 1) / 2 * kRows), kRows - 1);
        const int column = std::min(static_cast<int>((turn - std::floor(turn)) * kColumns), kColumns - 1);
        ++cells[static_cast<std::size_t>(row * kColumns + column)];
    }

    /// What `samples` draws with a density give on average.
    template <typename Density>
    static SphereHistogram expected(int samples, const Density& density) {
        constexpr int kSub = 10;
        SphereHistogram result;
        for (int i = 0; i < kRows * kSub; ++i) {
            for (int j = 0; j < kColumns * kSub; ++j) {
                const Vec3d w = towards(-1 + 2 * (i + 0.5) / (kRows * kSub),
                                        2 * std::numbers::pi * (j + 0.5) / (kColumns * kSub));
                result.cells[static_cast<std::size_t>(i / kSub * kColumns + j / kSub)] +=
                    density(w) * samples * 4 * std::numbers::pi / (kRows * kColumns * kSub * kSub);
            }
        }
        return result;
    }
};

/// Pearson's statistic as standard deviations of a normal variable [Wilson and Hilferty 1931]. Cells in which
/// few draws are expected count as one.
double chi_square_deviation(const SphereHistogram& observed, const SphereHistogram& expected) {
    double statistic = 0, rest_observed = 0, rest_expected = 0;
    int cells = 0;
    const auto count = [&](double o, double e) {
        statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (std::size_t i = 0; i < observed.cells.size(); ++i) {
        if (expected.cells[i] >= 8) {
            count(observed.cells[i], expected.cells[i]);
        } else {
            rest_observed += observed.cells[i];
            rest_expected += expected.cells[i];
        }
    }
    if (rest_expected >= 8 || rest_observed >= 8) {
        count(rest_observed, std::max(rest_expected, 1.0));
    }
    const double freedom = std::max(1, cells - 1);
    const double spread = 2 / (9 * freedom);
    return (std::cbrt(statistic / freedom) - (1 - spread)) / std::sqrt(spread);
}

void expect_near(Vec3d a, Vec3d b, double tolerance, const std::string& what) {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

TEST(Bsdf, SamplesFollowTheirDensity) {
    constexpr int kSamples = 200'000;
    Pcg32 random(3);
    for (const BsdfCase& test : all_bsdf_cases()) {
        for (const double cosine : kCosines) {
            const SurfaceBsdf bsdf = test.seen_from(towards(cosine));
            SphereHistogram observed;
            int drawn = 0;
            for (int i = 0; i < kSamples; ++i) {
                const double part = random.uniform();
                const SurfaceDraw draw = bsdf.sample(part, next_random(random));
                if (draw.pdf > 0 && !draw.is_delta) {
                    observed.add(draw.wi);
                    ++drawn;
                }
            }
            if (drawn == 0) {
                EXPECT_EQ(bsdf.pdf(towards(0.5)), 0) << test.name;
                continue;
            }
            const SphereHistogram expected =
                SphereHistogram::expected(kSamples, [&](Vec3d wi) { return bsdf.pdf(wi); });
            EXPECT_LT(chi_square_deviation(observed, expected), 4.5) << test.name << " at " << cosine;
        }
    }
}

TEST(Bsdf, WeightsAreTheBsdfOverTheDensity) {
    Pcg32 random(4);
    for (const BsdfCase& test : all_bsdf_cases()) {
        for (const double cosine : kCosines) {
            const SurfaceBsdf bsdf = test.seen_from(towards(cosine));
            for (int i = 0; i < 200; ++i) {
                const double part = random.uniform();
                const SurfaceDraw draw = bsdf.sample(part, next_random(random));
                if (draw.is_delta || draw.pdf == 0) {
                    continue;
                }
                const BsdfValue value = bsdf.eval(draw.wi);
                const double density = draw.is_diffuse ? bsdf.diffuse_chance() * bsdf.diffuse_pdf(draw.wi)
                                                       : bsdf.specular_chance() * bsdf.specular_pdf(draw.wi);
                EXPECT_NEAR(draw.pdf / density, 1, 1e-6) << test.name;
                expect_near(draw.weight, (draw.is_diffuse ? value.diffuse : value.specular) / density,
                            1e-6 * (1 + max_component(draw.weight)), test.name);
            }
        }
    }
}

// What one side sends to the other as flux, it would receive from it as radiance [Veach 1997, section 5.2].
TEST(Bsdf, IsReciprocal) {
    Pcg32 random(5);
    int compared = 0;
    for (const BsdfCase& test : all_bsdf_cases()) {
        for (int i = 0; i < 300; ++i) {
            const Vec3d a = towards(2 * random.uniform() - 1, 7 * random.uniform());
            const Vec3d b = towards(2 * random.uniform() - 1, 7 * random.uniform());
            const BsdfValue there = test.seen_from(a, Transport::flux).eval(b);
            const BsdfValue back = test.seen_from(b, Transport::radiance).eval(a);
            const Vec3d specular = there.specular / std::abs(b.z);
            if (test.name == "principled thin" && a.z * b.z < 0) {
                continue;  // its shadowing of what goes through is Mitsuba's, and one-sided
            }
            expect_near(specular, back.specular / std::abs(a.z), 1e-6 * (1 + max_component(specular)),
                        test.name);
            expect_near(there.diffuse / std::abs(b.z), back.diffuse / std::abs(a.z), 1e-9, test.name);
            compared += is_zero(specular) && is_zero(there.diffuse) ? 0 : 1;
        }
    }
    EXPECT_GT(compared, 1500);
}

TEST(Bsdf, AlbedoIsTheIntegralAndConservesEnergy) {
    for (const BsdfCase& test : all_bsdf_cases()) {
        for (const double cosine : kCosines) {
            const SurfaceBsdf bsdf = test.seen_from(towards(cosine), Transport::flux);
            const BsdfValue albedo = bsdf.albedo(60'000);
            const std::string what = test.name + " at " + std::to_string(cosine);
            if (test.conserves_energy) {
                EXPECT_LE(max_component(albedo.sum()), 1.0 + 1e-3) << what;
            }
            const Vec3d diffuse = sphere_quadrature(200, [&](Vec3d wi) { return bsdf.eval(wi).diffuse; });
            expect_near(albedo.diffuse, diffuse, 1e-3, what);
            if (!bsdf.has_specular()) {
                const Vec3d none = sphere_quadrature(40, [&](Vec3d wi) { return bsdf.eval(wi).specular; });
                EXPECT_TRUE(is_zero(none)) << what;
            }
            Pcg32 random(6);
            if (bsdf.has_specular() && !bsdf.sample_specular(next_random(random)).is_delta) {
                const Vec3d specular =
                    sphere_quadrature(200, [&](Vec3d wi) { return bsdf.eval(wi).specular; });
                expect_near(albedo.specular, specular, 3e-3, what);
            }
        }
    }
}

TEST(Bsdf, GlassLosesNothingToSmoothBoundaries) {
    for (const char* name : {"dielectric", "thin dielectric", "null"}) {
        for (const BsdfCase& test : glass_cases()) {
            for (const double cosine : kCosines) {
                if (test.name == name) {
                    const SurfaceBsdf bsdf = test.seen_from(towards(cosine), Transport::flux);
                    expect_near(bsdf.albedo(500).sum(), {1, 1, 1}, 1e-9, name);
                }
            }
        }
    }
}

// A denser body compresses radiance, which a path that comes out again expands.
TEST(Bsdf, RefractionFollowsSnellAndScalesRadiance) {
    const BsdfCase glass = glass_cases()[0];
    const Vec3d wo = towards(0.8);
    const SurfaceDraw in = glass.seen_from(wo).sample_specular({0.999, 0, 0});
    ASSERT_TRUE(in.is_delta);
    EXPECT_NEAR(std::sqrt(1 - in.wi.z * in.wi.z), 0.6 / 1.5, 1e-6);
    EXPECT_LT(in.wi.z, 0);
    EXPECT_NEAR(in.weight.x, 1 / 2.25, 1e-6);
    EXPECT_NEAR(in.eta, 1.5, 1e-6);
    const SurfaceDraw out = glass.seen_from(in.wi).sample_specular({0.999, 0, 0});
    expect_near(out.wi, wo, 1e-6, "back out");
    EXPECT_NEAR(out.weight.x * in.weight.x, 1, 1e-6);
    const SurfaceDraw total = glass.seen_from(towards(-0.3)).sample_specular({0.999, 0, 0});
    EXPECT_NEAR(total.wi.z, -0.3, 1e-6) << "total internal reflection";
}

}  // namespace
}  // namespace nearlight::core
