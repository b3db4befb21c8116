// SPDX-License-Identifier: Apache-2.0
// Expected values come from Mitsuba 3.9.1 (eval of `plastic` and `roughplastic` without specular reflection).
#include "host/scene/transmission_curve.h"

#include <gtest/gtest.h>

#include <utility>

#include "host/scene/layered_materials.h"
#include "host/scene/material_model.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

constexpr double kPlasticEta = 1.49 / 1.000277;

const float* curve_of(const Scene& scene, const Material& material) {
    return scene.transmission_curves.data() + std::size_t{material.curve} * NEARLIGHT_CURVE_SIZE;
}

struct PlasticCase {
    Coat coat;
    /// π · D at the cosines 1, 5, 10, 20, 40 and 62 ÷ 63, seen head-on, with a reflectance of 0.5.
    double expected[6];
};

TEST(TransmissionCurve, DiffusePartOfPlasticsIsMitsubas) {
    const PlasticCase cases[] = {
        {{kPlasticEta, 0, true, false}, {0.046474, 0.191328, 0.308343, 0.428746, 0.498682, 0.508507}},
        {{kPlasticEta, 0, true, true}, {0.027005, 0.111176, 0.179172, 0.249135, 0.289774, 0.295482}},
        {{kPlasticEta, 0.1, true, false}, {0.199837, 0.250002, 0.315944, 0.413169, 0.479574, 0.489584}},
        {{kPlasticEta, 0.1, true, true}, {0.119268, 0.149208, 0.188563, 0.246589, 0.286221, 0.292195}},
        {{kPlasticEta, 0.5, false, false}, {0.158551, 0.178231, 0.198137, 0.227173, 0.261188, 0.279032}},
        {{kPlasticEta, 0.5, false, true}, {0.132234, 0.148647, 0.165249, 0.189465, 0.217835, 0.232717}},
        {{1.9 / 1.000277, 0.02, false, false}, {0.112020, 0.187441, 0.279171, 0.379653, 0.443351, 0.454008}},
        {{kPlasticEta, 0.7, true, false}, {0.242390, 0.253966, 0.266027, 0.283681, 0.301766, 0.312822}},
        {{1.2 / 1.5, 0.3, true, false}, {0, 0, 0, 0.009984, 0.470103, 0.787176}},
        {{1.5, 0.1, false, true}, {0.167656, 0.174396, 0.197704, 0.240874, 0.275943, 0.282551}},
    };
    const std::size_t rows[] = {4, 20, 40, 80, 160, 248};
    // Materials that stand in the scene already may lend their coats, but only to those that have the same.
    Scene scene;
    for (const PlasticCase& c : cases) {
        SCOPED_TRACE(c.coat.alpha);
        const Material material = plastic_material(scene, c.coat);
        scene.materials.push_back(material);
        const float* curve = curve_of(scene, material);
        const double inside = static_cast<double>(material.internal_reflectance);
        const double color = 0.5 / (1 - inside * (c.coat.nonlinear ? 0.5 : 1.0)) / (c.coat.eta * c.coat.eta);
        for (std::size_t i = 0; i < 6; ++i) {
            const double d = color * static_cast<double>(curve[rows[i]]) * static_cast<double>(curve[252]);
            // Light that meets a coat ten times multiplies an error of the curve by more than ten.
            EXPECT_NEAR(d, c.expected[i], 1e-5 * c.expected[i] + 1e-6) << rows[i];
        }
    }
}

TEST(TransmissionCurve, SmoothCoatsLetThroughWhatTheyDoNotReflect) {
    const TransmissionCurve curve = smooth_coat_curve(1.5);
    EXPECT_EQ(curve[0], 0.0f);
    EXPECT_NEAR(curve[252], 0.96f, 1e-6f);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        EXPECT_NEAR(curve[i], 1.0 - dielectric_reflectance(static_cast<double>(i) / 252, 1.5), 1e-6);
    }
}

TEST(TransmissionCurve, SmoothCoatsLetThroughTheRightAmountBetweenValuesToo) {
    for (const double eta : {1.2, 1.33, 1.5, 1.9}) {
        const TransmissionCurve curve = smooth_coat_curve(eta);
        const double steps = NEARLIGHT_CURVE_SIZE - 1;
        double sum = 0.0;  // ∫ T(c) c dc, in steps
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
            const auto at = static_cast<double>(i);
            sum += curve[i] * (at / 2 + 1.0 / 6) + curve[i + 1] * (at / 2 + 1.0 / 3);
        }
        EXPECT_NEAR(2 * sum / (steps * steps), 1.0 - mean_dielectric_reflectance(eta), 2e-5) << eta;
    }
}

TEST(TransmissionCurve, VeryFineMicrofacetsAreNearlySmooth) {
    const TransmissionCurve smooth = smooth_coat_curve(1.5);
    for (const bool beckmann : {false, true}) {
        const TransmissionCurve fine = rough_coat_curve(1.5, 2e-3, beckmann);
        for (std::size_t i = 16; i < smooth.size(); ++i) {
            EXPECT_NEAR(fine[i], smooth[i], 2e-3f) << i;
        }
    }
}

TEST(TransmissionCurve, PrincipledHalvesGrazingLight) {
    const TransmissionCurve curve = principled_curve();
    EXPECT_EQ(curve[0], 0.5f);
    EXPECT_EQ(curve[252], 1.0f);
    Scene scene;
    EXPECT_EQ(principled_material(scene, 1.5).curve, 1u);
    EXPECT_EQ(principled_material(scene, 1.8).curve, 1u);  // equal rows are shared
    EXPECT_EQ(scene.transmission_curves.size(), 2u * NEARLIGHT_CURVE_SIZE);
}

/// What a base of albedo 1 reflects below a smooth surface is all that the surface lets through.
TEST(TransmissionCurve, ABaseGetsWhatItsLayersLeave) {
    const TransmissionCurve layered = layered_curve({.eta = 1.5, .roughness = 0});
    const TransmissionCurve smooth = smooth_coat_curve(1.5);
    for (std::size_t i = 16; i < smooth.size(); i += 4) {  // between these the curve is linear
        EXPECT_NEAR(layered[i] * mean_transmission(layered), smooth[i], 2e-3f) << i;
    }
    const auto base = [](const Layers& layers) { return mean_transmission(layered_curve(layers)); };
    EXPECT_LT(base({.eta = 1.8}), base({.eta = 1.5}));
    EXPECT_LT(base({.clearcoat = 1}), base({}));
    EXPECT_LT(base({.sheen = 1}), base({}));
}

/// What facets of roughness 1 reflect, by the rule of the midpoints over visible normals that spherical caps
/// give [Dupuy & Benyoub 2023]: much less than smooth ones, because they shadow most of it, but not nothing.
TEST(TransmissionCurve, TheRoughestLayersStillReflect) {
    const TransmissionCurve rough = layered_curve({.eta = 1.5, .roughness = 1});
    for (const auto& [i, reflected] : {std::pair{20u, 0.041f},
                                       {60u, 0.0308f},
                                       {100u, 0.0241f},
                                       {160u, 0.0178f},
                                       {220u, 0.0141f},
                                       {252u, 0.0127f}}) {
        EXPECT_NEAR(1 - rough[i] * mean_transmission(rough), reflected, 5e-4f) << i;
    }
}

TEST(TransmissionCurve, LayersThatAreNearlyAlikeShareACurve) {
    Scene scene;
    LayeredMaterials materials;
    const uint curve = materials.of(scene, {.roughness = 0.5}).curve;
    EXPECT_EQ(materials.of(scene, {.roughness = 0.503}).curve, curve);
    EXPECT_NE(materials.of(scene, {.roughness = 0.55}).curve, curve);
    EXPECT_NE(materials.of(scene, {.eta = 1.6, .roughness = 0.5}).curve, curve);
}

TEST(TransmissionCurve, RowZeroIsAllOnes) {
    const Scene scene;
    ASSERT_EQ(scene.transmission_curves.size(), std::size_t{NEARLIGHT_CURVE_SIZE});
    for (const float value : scene.transmission_curves) {
        EXPECT_EQ(value, 1.0f);
    }
}

TEST(TransmissionCurve, MoreThanReceiversTellApartAreRefused) {
    Scene scene;
    const std::size_t rows = 0xffff;  // with row zero, one more than the largest number of 16 bits
    scene.transmission_curves.resize((rows + 1) * NEARLIGHT_CURVE_SIZE, 0.5f);
    TransmissionCurve halves;
    halves.fill(0.5f);
    EXPECT_EQ(add_curve(scene, halves), 1u) << "a curve that is there is shared";
    const Error error = test::error_of([&] { add_curve(scene, smooth_coat_curve(1.5)); });
    EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
    EXPECT_TRUE(test::mentions(error, "65535 different coats"));
}

// The fits are good to 0.2 % and 0.6 % of the integral.
TEST(TransmissionCurve, InternalReflectanceIsTheMeanFromInside) {
    for (const double eta : {1.2, 1.33, 1.5, 1.8}) {
        const double inside = mean_dielectric_reflectance(1.0 / eta);
        EXPECT_NEAR(smooth_internal_reflectance(eta), inside, 0.008 * inside) << eta;
    }
}

}  // namespace
}  // namespace nearlight::core
