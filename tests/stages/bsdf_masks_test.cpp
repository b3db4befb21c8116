// SPDX-License-Identifier: Apache-2.0
// Masks and blends, which choose by chance what a point of the surface is.
#include <gtest/gtest.h>

#include "tests/support/bsdf_materials.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace test;

class BsdfMasksTest : public DeviceTest {};

constexpr uint kChoices = 4000;

/// One query for each of evenly spread choices.
std::vector<BsdfQuery> all_choices() {
    std::vector<BsdfQuery> queries(kChoices, make_query(direction_at(20), direction_at(0), kBothParts));
    for (uint i = 0; i < kChoices; ++i) {
        queries[i].choice = (static_cast<float>(i) + 0.5f) / kChoices;
    }
    return queries;
}

double mean_value(const std::vector<BsdfAnswer>& answers) {
    double sum = 0;
    for (const BsdfAnswer& answer : answers) {
        sum += answer.value.x / static_cast<double>(answers.size());
    }
    return sum;
}

/// A mask of 0.7 over a blend of which 0.25 is the second material.
TEST_F(BsdfMasksTest, MasksAndBlendsHaveTheirProbabilities) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        scene.materials = {make_wrapper(NEARLIGHT_BSDF_MASK, constant(0.7f), 1, 1),
                           make_wrapper(NEARLIGHT_BSDF_BLEND, constant(0.25f), 2, 3),
                           make_diffuse(constant(0.2f)), make_diffuse(constant(0.9f))};
        const std::vector<BsdfQuery> queries = all_choices();
        const std::vector<BsdfAnswer> answers = probe.ask(scene, queries);
        int passed = 0;
        for (const BsdfAnswer& answer : answers) {
            passed += answer.is_delta != 0 ? 1 : 0;
            if (answer.is_delta != 0) {
                EXPECT_NEAR(answer.wi.z, -queries[0].wo.z, 1e-6f);
                EXPECT_EQ(answer.weight.x, 1.0f);
            }
        }
        EXPECT_NEAR(passed, 0.3 * kChoices, 1.5);
        EXPECT_NEAR(mean_value(answers), 0.7 * (0.75 * 0.2 + 0.25 * 0.9) / kPi, 2e-4);
        for (const float opacity : {0.0f, 1.0f}) {
            scene.materials[0].reflectance = constant(opacity);
            for (const BsdfAnswer& answer : probe.ask(scene, queries)) {
                EXPECT_EQ(answer.is_delta, opacity == 0 ? 1u : 0u);
            }
        }
    });
}

/// Blends whose first or second material is a blend again: each choice among them is independent of the one
/// before, so that both parts of the inner one have half of its share.
TEST_F(BsdfMasksTest, BlendsInBlendsHaveTheirProbabilities) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        scene.materials = {{},
                           make_wrapper(NEARLIGHT_BSDF_BLEND, constant(0.5f), 3, 4),
                           make_diffuse(constant(0.0f)),
                           make_diffuse(constant(0.2f)),
                           make_diffuse(constant(0.9f))};
        for (const bool inner_is_second : {false, true}) {
            scene.materials[0] = inner_is_second ? make_wrapper(NEARLIGHT_BSDF_BLEND, constant(0.6f), 2, 1)
                                                 : make_wrapper(NEARLIGHT_BSDF_BLEND, constant(0.4f), 1, 2);
            EXPECT_NEAR(mean_value(probe.ask(scene, all_choices())), 0.6 * (0.5 * 0.2 + 0.5 * 0.9) / kPi,
                        2e-4)
                << inner_is_second;
        }
    });
}

/// A normal that leans, for both ends of a path in front of it.
Material leaning_map(uint child) {
    Material map = make_wrapper(NEARLIGHT_BSDF_NORMAL_MAP, constant(0.0f), child, child);
    map.reflectance = constant(Vec3{0.6f, 0.5f, 0.9f});
    map.flags = NEARLIGHT_MATERIAL_TANGENT;
    return map;
}

BsdfScene scene_with_maps(const Material& below, uint maps) {
    BsdfScene scene;
    scene.materials = {leaning_map(maps == 2 ? 1 : 2), leaning_map(2), below, make_diffuse(constant(0.2f)),
                       make_diffuse(constant(0.9f))};
    return scene;
}

/// What a white material under maps sends of the light of all_choices() to its viewer.
double radiance_under_maps(BsdfProbe& probe, uint maps) {
    return probe
        .ask(scene_with_maps(make_diffuse(constant(1.0f)), maps),
             make_query(direction_at(0), direction_at(20), kBothParts))
        .value.x;
}

/// The map decides by chance whether a path of flux sees its normal turned, and what lies below has to decide
/// apart from that: the mean over all choices is the reflectance of what is below, whose light is compared
/// with that of a plain material under the map. This is the radiance along the same path the other way, times
/// the quotient of the cosines to the mesh.
TEST_F(BsdfMasksTest, BlendsAndMasksUnderMapsHaveTheirProbabilities) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        const auto mean_under_maps = [&](Material below, uint maps) {
            std::vector<BsdfQuery> queries = all_choices();
            for (BsdfQuery& query : queries) {
                query.mode = kFlux;
            }
            return mean_value(probe.ask(scene_with_maps(below, maps), queries));
        };
        for (const uint maps : {1u, 2u}) {
            const double white = mean_under_maps(make_diffuse(constant(1.0f)), maps);
            EXPECT_NEAR(white, radiance_under_maps(probe, maps) / direction_at(20).z, 1e-3 * white);
            const Material blend = make_wrapper(NEARLIGHT_BSDF_BLEND, constant(0.25f), 3, 4);
            EXPECT_NEAR(mean_under_maps(blend, maps) / white, 0.75 * 0.2 + 0.25 * 0.9, 2e-3);
            const Material mask = make_wrapper(NEARLIGHT_BSDF_MASK, constant(0.6f), 4, 4);
            EXPECT_NEAR(mean_under_maps(mask, maps) / white, 0.6 * 0.9, 2e-3);
        }
    });
}

/// What a mask lets through goes straight on from either side, also where the surface behind it is one-sided.
TEST_F(BsdfMasksTest, MasksLetLightThroughFromBothSides) {
    on_each_device([](Device& device) {
        BsdfProbe probe(device);
        BsdfScene scene;
        scene.materials = {make_wrapper(NEARLIGHT_BSDF_MASK, constant(0.0f), 1, 1),
                           make_diffuse(constant(0.2f))};
        for (const uint mode : {kRadiance, kFlux}) {
            for (const Vec3 wo : {direction_at(20), direction_at(160)}) {
                const BsdfAnswer answer = probe.ask(scene, make_query(wo, direction_at(0), kBothParts, mode));
                EXPECT_EQ(answer.is_delta, 1u);
                EXPECT_NEAR(dot(answer.wi, -wo), 1.0f, 1e-5f);
                EXPECT_NEAR(answer.weight.x, 1.0f, 1e-5f);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
