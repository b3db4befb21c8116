// SPDX-License-Identifier: Apache-2.0
// Requirements on all samplers that consider the camera: they keep all light, make about as many VPLs as they
// are asked for, and work in scenes in which nothing is visible.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"
#include "tests/support/spread.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::divided_room;
using test::SamplingBench;

constexpr uint kDepths = 3;

class BidirectionalTest : public test::DeviceTest {};

std::string test_name(const ::testing::TestParamInfo<SamplerKind>& info) {
    return to_string(info.param);
}

class ImportanceSamplerTest : public test::DeviceTest, public ::testing::WithParamInterface<SamplerKind> {};
INSTANTIATE_TEST_SUITE_P(, ImportanceSamplerTest,
                         ::testing::Values(SamplerKind::rejection, SamplerKind::metropolis), test_name);

double total(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The mean power at each depth over many seeds is the known flux at that depth.
void expect_all_light(SamplingBench& bench, SamplerKind sampler, uint vpl_count, uint seeds,
                      double max_error) {
    std::vector<std::vector<double>> power(kDepths);
    for (uint seed = 0; seed < seeds; ++seed) {
        const VplSet set = bench.sample(sampler, vpl_count, 50 + seed, kDepths);
        for (uint depth = 1; depth <= kDepths; ++depth) {
            power[depth - 1].push_back(test::power_at_depth(set, depth));
        }
    }
    for (uint depth = 1; depth <= kDepths; ++depth) {
        const double expected = test::kLightFlux * std::pow(test::kRoomAlbedo, depth);
        const test::Spread found = test::spread_of(power[depth - 1]);
        // Walks are well spread, so the rounding of their number may be the only error.
        EXPECT_NEAR(found.mean, expected, 4 * found.error + 0.003 * expected)
            << vpl_count << " VPLs, depth " << depth;
        EXPECT_LT(found.error, max_error * expected)
            << vpl_count << " VPLs, depth " << depth << ": too noisy to tell";
    }
}

TEST_P(ImportanceSamplerTest, KeepsTheLightOfEachDepth) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        ASSERT_GT(bench.view().importons.count, 500u);
        expect_all_light(bench, GetParam(), 900, 60, 0.03);
    });
}

/// Few VPLs give a poor estimate of all light, but a good one of the light that they are chosen for.
TEST_P(ImportanceSamplerTest, SmallBudgetsAreUnbiasedToo) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const double expected =
            total(bench.contributions(bench.sample(SamplerKind::instant_radiosity, 100'000, 1)));
        for (const uint budget : {1u, 2u, 63u}) {
            std::vector<double> brought;
            for (uint seed = 0; seed < 100; ++seed) {
                brought.push_back(total(bench.contributions(bench.sample(GetParam(), budget, 300 + seed))));
            }
            const test::Spread found = test::spread_of(brought);
            EXPECT_NEAR(found.mean, expected, 4 * found.error + 0.01 * expected) << budget << " VPLs";
            EXPECT_LT(found.error, 0.12 * expected) << budget << " VPLs: too noisy to tell";
        }
    });
}

TEST_P(ImportanceSamplerTest, GivesAboutAsManyAsWanted) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        for (const uint wanted : {100u, 1000u}) {
            double count = 0;
            for (uint seed = 0; seed < 8; ++seed) {
                const VplSet set = bench.sample(GetParam(), wanted, seed);
                count += static_cast<double>(set.vpls.count()) / 8;
                EXPECT_EQ(set.distant_count, set.vpls.count());
                EXPECT_GT(set.candidate_count, 2 * set.vpls.count()) << "no choice was made";
            }
            EXPECT_NEAR(count, wanted, 0.1 * wanted);
        }
    });
}

TEST_P(ImportanceSamplerTest, EvensOutWhatVplsBringToTheCamera) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const auto unevenness = [&](SamplerKind sampler) {
            const std::vector<float> contributions = bench.contributions(bench.sample(sampler, 1000, 3));
            double squares = 0;
            for (const float c : contributions) {
                squares += double(c) * c;
            }
            const double sum = total(contributions);
            // This is 1 if all VPLs bring the same.
            return squares * static_cast<double>(contributions.size()) / (sum * sum);
        };
        const double walks = unevenness(SamplerKind::instant_radiosity);
        EXPECT_GT(walks, 2.5);
        EXPECT_LT(unevenness(GetParam()), 1 + 0.2 * (walks - 1));
    });
}

TEST_P(ImportanceSamplerTest, SameSeedSameBits) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const auto bytes = [&](uint seed) {
            const std::vector<Vpl> vpls = bench.sample(GetParam(), 300, seed).vpls.download();
            return std::string(reinterpret_cast<const char*>(vpls.data()), vpls.size() * sizeof(Vpl));
        };
        const std::string first = bytes(7);
        EXPECT_FALSE(first.empty());
        EXPECT_EQ(bytes(7), first);
        EXPECT_NE(bytes(8), first);
    });
}

/// Few of the first walks bring light through a slit. So many chains start from each of them that the same
/// state is picked several times.
TEST_P(ImportanceSamplerTest, FewWalksThatBringLightAreUnbiasedToo) {
    constexpr float kSlit = 0.05f;  // m
    Scene scene = divided_room();
    add_quad(scene, {0.4f, -1, 0}, {0, 2, 0}, {0.6f - kSlit, 0, 0}, 0);
    on_each_device([&](Device& device) {
        SamplingBench bench(device, scene);
        const auto spread_by = [&](SamplerKind sampler, uint budget, uint seeds) {
            std::vector<double> brought;
            for (uint seed = 0; seed < seeds; ++seed) {
                brought.push_back(total(bench.contributions(bench.sample(sampler, budget, 700 + seed))));
            }
            return test::spread_of(brought);
        };
        const test::Spread expected = spread_by(SamplerKind::instant_radiosity, 100'000, 12);
        const test::Spread found = spread_by(GetParam(), 256, 60);
        EXPECT_NEAR(found.mean, expected.mean, 4 * std::hypot(found.error, expected.error));
        EXPECT_LT(std::hypot(found.error, expected.error), 0.05 * expected.mean) << "too noisy to tell";
    });
}

/// A camera that looks away from everything has no importons. Any set that carries the light is right then.
TEST_P(ImportanceSamplerTest, SeesNothingAndStillKeepsTheLight) {
    Scene scene = divided_room();
    set_camera(scene, {0, 0, 10}, {0, 0, 20}, 40);
    on_each_device([&](Device& device) {
        SamplingBench bench(device, scene);
        ASSERT_EQ(bench.view().importons.count, 0u);
        expect_all_light(bench, GetParam(), 300, 30, 0.05);
    });
}

/// No light reaches what the camera sees, so all contributions and the picture are 0.
TEST_P(ImportanceSamplerTest, WhatNoLightReachesIsNoTrouble) {
    Scene scene = divided_room();
    add_quad(scene, {0.4f, -1, 0}, {0, 2, 0}, {0.6f, 0, 0}, 0);  // closes the gap
    on_each_device([&](Device& device) {
        SamplingBench bench(device, scene);
        ASSERT_GT(bench.view().importons.count, 500u);
        expect_all_light(bench, GetParam(), 900, 4, 0.05);
    });
}

TEST_P(ImportanceSamplerTest, WithoutLightThereAreNoVpls) {
    Scene dark = divided_room();
    dark.delta_emitters.clear();
    Scene missed;  // the light shines on the back of a one-sided surface
    add_quad(missed, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(missed, lambertian({1, 1, 1})));
    add_point_light(missed, {0, 0, -1}, {1, 1, 1});
    set_camera(missed, {0, 0, 3}, {0, 0, 0}, 60);
    on_each_device([&](Device& device) {
        EXPECT_TRUE(SamplingBench(device, dark).sample(GetParam(), 100, 1).vpls.empty());
        EXPECT_TRUE(SamplingBench(device, missed).sample(GetParam(), 100, 1).vpls.empty());
        SamplingBench bench(device, divided_room());
        EXPECT_TRUE(bench.sample(GetParam(), 0, 1).vpls.empty());
        EXPECT_TRUE(bench.sample(GetParam(), 100, 1, 0).vpls.empty());
    });
}

/// Its two kinds of VPLs lie in the same places, and the weights of both must add up to 1.
TEST_F(BidirectionalTest, BringsTheLightOfWalks) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const double expected =
            total(bench.contributions(bench.sample(SamplerKind::instant_radiosity, 100'000, 1)));
        std::vector<double> brought;
        for (uint seed = 0; seed < 40; ++seed) {
            brought.push_back(
                total(bench.contributions(bench.sample(SamplerKind::bidirectional, 300, 500 + seed))));
        }
        const test::Spread found = test::spread_of(brought);
        EXPECT_NEAR(found.mean, expected, 4 * found.error + 0.01 * expected);
        EXPECT_LT(found.error, 0.02 * expected) << "too noisy to tell";
    });
}

}  // namespace
}  // namespace nearlight::core
