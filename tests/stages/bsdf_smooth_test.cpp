// SPDX-License-Identifier: Apache-2.0
// Mirror images, refractions and what passes straight on, against the laws of Snell and Fresnel.
#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/material_model.h"
#include "tests/support/bsdf_materials.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace test;

constexpr float kIndex = 1.5f;
constexpr float kMirrorTint = 0.9f;
constexpr float kThroughTint = 0.5f;
constexpr uint kDraws = 2000;

/// What a smooth surface does with light: the share that it reflects, where the rest goes, and the weight
/// there.
struct Boundary {
    double reflectance;
    Vec3 through;
    float weight;
};

Material tinted(Material material) {
    material.specular = constant(kMirrorTint);
    material.transmission = constant(kThroughTint);
    return material;
}

void expect_boundary(BsdfProbe& probe, const Material& material, Vec3 wo, uint mode,
                     const Boundary& expected) {
    std::vector<BsdfQuery> queries(kDraws, make_query(wo, {0, 0, 1}, kPartS, mode));
    for (uint i = 0; i < kDraws; ++i) {
        queries[i].u = (static_cast<float>(i) + 0.5f) / kDraws;
    }
    const Vec3 mirrored{-wo.x, -wo.y, wo.z};
    uint reflected = 0;
    for (const BsdfAnswer& answer : probe.ask(scene_of(material), queries)) {
        const bool reflects = answer.wi.z * wo.z > 0;
        reflected += reflects ? 1 : 0;
        EXPECT_EQ(answer.is_delta, 1u);
        EXPECT_LT(length(answer.wi - (reflects ? mirrored : expected.through)), 1e-5f);
        EXPECT_NEAR(answer.weight.y, reflects ? kMirrorTint : expected.weight, 1e-5f);
    }
    EXPECT_NEAR(static_cast<double>(reflected) / kDraws, expected.reflectance, 1.5 / kDraws);
}

class BsdfSmoothTest : public DeviceTest {};

TEST_F(BsdfSmoothTest, GlassReflectsAndRefractsOnBothSides) {
    const Material glass = tinted(make_glass(0, 0, 0));
    on_each_device([&](Device& device) {
        BsdfProbe probe(device);
        for (const float degrees : {30.0f, 75.0f, 150.0f, 110.0f}) {
            for (const uint mode : {kRadiance, kFlux}) {
                SCOPED_TRACE(testing::Message() << degrees << " degrees, mode " << mode);
                const Vec3 wo = direction_at(degrees);
                const float eta = wo.z > 0 ? kIndex : 1 / kIndex;
                const double cosine = std::abs(static_cast<double>(wo.z));
                const float depth2 = 1 - (1 - wo.z * wo.z) / (eta * eta);
                const Vec3 through{-wo.x / eta, -wo.y / eta,
                                   std::copysign(std::sqrt(std::max(depth2, 0.0f)), -wo.z)};
                // Radiance is squeezed into a smaller solid angle behind the boundary, flux is not.
                const float scale = mode == kRadiance ? 1 / (eta * eta) : 1;
                const double reflectance =
                    depth2 > 0 ? dielectric_reflectance(cosine, static_cast<double>(eta)) : 1.0;
                expect_boundary(probe, glass, wo, mode, {reflectance, through, kThroughTint * scale});
            }
        }
    });
}

/// They reflect every draw, with Fresnel's reflectance of the boundary as the weight.
TEST_F(BsdfSmoothTest, MetalsAndCoatsMirror) {
    constexpr float kEta = 0.92f;
    constexpr float kExtinction = 2.45f;
    const Material metal =
        tinted(make_metal(0, 0, 0, Vec3{kEta, kEta, kEta}, Vec3{kExtinction, kExtinction, kExtinction}));
    const Material coat = tinted(make_plastic(0, 0));
    on_each_device([&](Device& device) {
        BsdfProbe probe(device);
        for (const float degrees : {10.0f, 50.0f, 80.0f}) {
            SCOPED_TRACE(degrees);
            const Vec3 wo = direction_at(degrees);
            const Vec3 mirrored{-wo.x, -wo.y, wo.z};
            const auto expect_mirrored = [&](const Material& material, double reflectance) {
                const BsdfAnswer answer =
                    probe.ask(scene_of(material), make_query(wo, {0, 0, 1}, kPartS, kRadiance));
                EXPECT_EQ(answer.is_delta, 1u);
                EXPECT_LT(length(answer.wi - mirrored), 1e-5f);
                EXPECT_NEAR(answer.weight.y, kMirrorTint * reflectance, 1e-5);
            };
            const auto cosine = static_cast<double>(wo.z);
            expect_mirrored(metal, conductor_reflectance(cosine, static_cast<double>(kEta),
                                                         static_cast<double>(kExtinction)));
            expect_mirrored(coat, dielectric_reflectance(cosine, 1.5));
        }
    });
}

TEST_F(BsdfSmoothTest, PanesReflectBetweenTheirFaces) {
    const Material pane = tinted(make_material(NEARLIGHT_BSDF_THIN_DIELECTRIC));
    on_each_device([&](Device& device) {
        BsdfProbe probe(device);
        for (const float degrees : {30.0f, 75.0f, 150.0f}) {
            SCOPED_TRACE(degrees);
            const Vec3 wo = direction_at(degrees);
            const double face = dielectric_reflectance(std::abs(static_cast<double>(wo.z)), 1.5);
            // r + t·r·t + t·r³·t + … with t = 1 − r.
            expect_boundary(probe, pane, wo, kRadiance, {2 * face / (1 + face), -wo, kThroughTint});
        }
    });
}

}  // namespace
}  // namespace nearlight::core
