// SPDX-License-Identifier: Apache-2.0
#include "host/stages/gatherer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/bvh/bvh.h"
#include "host/bvh/segment_distance.h"
#include "host/bvh/wide_bvh.h"
#include "tests/stages/gatherer_variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

/// Numbers of pairs about which kernel and host differ, by kind, and of all rays.
struct Differences {
    std::size_t rays = 0;
    std::size_t culling = 0;    ///< one side culls, though no cosine is near zero
    std::size_t at_edges = 0;   ///< visibility differs, and the segment passes an edge within the tolerance
    std::size_t elsewhere = 0;  ///< visibility differs for no such reason
};

Differences compare(const GatherCase& data, const std::vector<GatherPair>& pairs) {
    // The tolerance is relative to the extent of the scene.
    const double tolerance = 1e-5 * data.extent;
    Differences result;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vpl& vpl = data.vpls[i / NEARLIGHT_PACKET_SIZE % data.vpls.size()];
        const ReceiverPoint receiver = receiver_at(
            data.receivers[i / NEARLIGHT_PACKET_SIZE / data.vpls.size()], i % NEARLIGHT_PACKET_SIZE);
        const PairTerm term = pair_term(vpl, receiver, data.clamp_radius);
        if ((term.value > 0.0) != (pairs[i] != GatherPair::culled)) {
            result.culling += term.min_cosine > 1e-6 ? 1 : 0;
            continue;
        }
        if (pairs[i] == GatherPair::culled) {
            continue;
        }
        ++result.rays;
        const bool blocked = occluded(data.bvh, vpl.position, receiver.position - vpl.position,
                                      NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX);
        if (blocked != (pairs[i] == GatherPair::occluded)) {
            const double distance = distance_to_edges(data.bvh.triangles, vpl.position, receiver.position);
            ++(distance <= tolerance ? result.at_edges : result.elsewhere);
        }
    }
    return result;
}

/// Irradiance by a double-precision sum over the pairs that are visible.
std::vector<IrradiancePacket> sum_visible(const GatherCase& data, const std::vector<GatherPair>& pairs) {
    std::vector<IrradiancePacket> result(data.receivers.size());
    for (std::size_t p = 0; p < data.receivers.size(); ++p) {
        for (std::size_t lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            double r = 0, g = 0, b = 0;
            for (std::size_t v = 0; v < data.vpls.size(); ++v) {
                if (pairs[(p * data.vpls.size() + v) * NEARLIGHT_PACKET_SIZE + lane] == GatherPair::visible) {
                    const Vpl& vpl = data.vpls[v];
                    const double term =
                        pair_term(vpl, receiver_at(data.receivers[p], lane), data.clamp_radius).value / M_PI;
                    r += term * vpl.power.x;
                    g += term * vpl.power.y;
                    b += term * vpl.power.z;
                }
            }
            result[p].r[lane] = static_cast<float>(r);
            result[p].g[lane] = static_cast<float>(g);
            result[p].b[lane] = static_cast<float>(b);
        }
    }
    return result;
}

class GathererTest : public DeviceTest {
  protected:
    void check_case(const GatherCase& data, double edge_share) {
        on_each_device([&](Device& device) {
            for (const Variant& variant : variants()) {
                SCOPED_TRACE(data.name + ", " + variant.name);
                Gatherer gatherer(device, variant.config);
                Uploaded uploaded(device, data);
                const std::vector<GatherPair> pairs =
                    gatherer.gather_recorded(uploaded.input(), uploaded.sums());
                const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
                expect_close(recorded, sum_visible(data, pairs));
                expect_close(uploaded.gather(gatherer), recorded);
                const Differences differences = compare(data, pairs);
                EXPECT_EQ(differences.culling, 0u);
                EXPECT_EQ(differences.elsewhere, 0u);
                EXPECT_LE(static_cast<double>(differences.at_edges),
                          edge_share * static_cast<double>(differences.rays) + (edge_share > 0 ? 1 : 0));
                if (!data.vpls.empty() && !data.receivers.empty()) {
                    EXPECT_GT(differences.rays, 0u);
                }
            }
        });
    }
};

TEST_F(GathererTest, RandomTriangles) {
    check_case(random_triangles(500, 257, 12, 1), 1e-5);
    check_case(random_triangles(3, 40, 3, 2), 1e-5);
}

TEST_F(GathererTest, RoomOfAxisAlignedBoxes) {
    check_case(room_of_boxes(60, 257, 12, 3), 1e-5);
}

// Points are on the grid of the triangles' corners, so segments run along edges, through corners and inside
// planes, where either answer is right.
TEST_F(GathererTest, SegmentsAlongEdgesAndPlanes) {
    check_case(points_on_grid(64, 12, 4), 1.0);
}

TEST_F(GathererTest, NeedlesAndTrianglesWithoutArea) {
    check_case(needles(400, 100, 12, 5), 1e-4);
}

TEST_F(GathererTest, NoTriangles) {
    check_case(random_triangles(0, 10, 2, 6), 0.0);
}

TEST_F(GathererTest, AnyNumberOfVpls) {
    for (const std::size_t count : {0, 1, 255, 256, 257}) {
        check_case(random_triangles(100, count, 2, 7), 1e-5);
    }
}

TEST_F(GathererTest, NoReceivers) {
    check_case(random_triangles(100, 10, 0, 8), 0.0);
}

// 2 km of ground have receivers stand 2 mm off their surfaces.
TEST_F(GathererTest, WhatIsMillimetresAwayHidesLightFromAfar) {
    const GatherCase data = sheet_above_receivers(0.003f, 1000.0f, 20, 2);
    on_each_device([&](Device& device) {
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Gatherer gatherer(device, variant.config);
            Uploaded uploaded(device, data);
            const std::vector<GatherPair> pairs = gatherer.gather_recorded(uploaded.input(), uploaded.sums());
            EXPECT_EQ(std::ranges::count(pairs, GatherPair::occluded),
                      static_cast<std::ptrdiff_t>(pairs.size()));
        }
    });
}

TEST_F(GathererTest, DivisionIntoLaunchesDoesNotChangeABit) {
    const GatherCase data = random_triangles(200, 1000, 7, 9);
    on_each_device([&](Device& device) {
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Uploaded uploaded(device, data);
            std::vector<std::vector<IrradiancePacket>> results;
            for (const std::uint64_t pairs :
                 {std::uint64_t{1}, std::uint64_t{3} << 14u, std::uint64_t{1} << 40u}) {
                GatherConfig config = variant.config;
                config.first_launch_pairs = pairs;
                config.launch_seconds = pairs == 1 ? 1e-9 : 1.0;
                Gatherer gatherer(device, config);
                results.push_back(uploaded.gather(gatherer));
            }
            EXPECT_TRUE(same_bits(results[0], results[1]));
            EXPECT_TRUE(same_bits(results[0], results[2]));
        }
    });
}

TEST_F(GathererTest, BeamWidthDoesNotChangeABit) {
    for (const GatherCase& data : {random_triangles(500, 257, 13, 14), room_of_boxes(60, 100, 13, 15),
                                   points_on_grid(64, 13, 16), needles(400, 100, 13, 17)}) {
        on_each_device([&](Device& device) {
            Uploaded uploaded(device, data);
            std::vector<std::vector<IrradiancePacket>> results;
            for (const uint width : {256, 128, 64, 32, 16}) {
                Gatherer gatherer(device, {GatherKernel::packets, width});
                results.push_back(uploaded.gather(gatherer));
                EXPECT_TRUE(same_bits(results.front(), results.back())) << data.name << ", width " << width;
            }
        });
    }
}

TEST_F(GathererTest, ProgressCountsPairsAndCancels) {
    const GatherCase data = random_triangles(50, 1000, 5, 10);
    on_each_device([&](Device& device) {
        GatherConfig config{.beam_width = NEARLIGHT_PACKET_SIZE};
        config.first_launch_pairs = 1;
        config.launch_seconds = 1e-9;
        Gatherer gatherer(device, config);
        Uploaded uploaded(device, data);
        std::vector<std::uint64_t> steps;
        const std::uint64_t all = 5ull * 1000 * NEARLIGHT_PACKET_SIZE;
        EXPECT_TRUE(
            gatherer.gather(uploaded.input(), uploaded.sums(), [&](std::uint64_t done, std::uint64_t total) {
                EXPECT_EQ(total, all);
                EXPECT_GT(done, steps.empty() ? 0 : steps.back());
                steps.push_back(done);
                return true;
            }));
        EXPECT_EQ(steps.size(), 2u * 4u);  // bundles × chunks of 256
        EXPECT_EQ(steps.back(), all);
        int calls = 0;
        EXPECT_FALSE(gatherer.gather(uploaded.input(), uploaded.sums(),
                                     [&](std::uint64_t, std::uint64_t) { return ++calls < 3; }));
        EXPECT_EQ(calls, 3);
    });
}

TEST_F(GathererTest, CountsMayBeSmallerThanBuffers) {
    const GatherCase data = random_triangles(100, 300, 4, 11);
    GatherCase fewer = data;
    fewer.vpls.resize(77);
    fewer.receivers.resize(2);
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded expected(device, fewer);
        Uploaded uploaded(device, data);
        GatherInput<Vpl> input = uploaded.input();
        input.vpl_count = 77;
        input.packet_count = 2;
        EXPECT_TRUE(gatherer.gather(input, uploaded.sums()));
        std::vector<IrradiancePacket> actual = uploaded.sums().light.download();
        EXPECT_TRUE(std::isnan(actual[2].r[0])) << "written beyond the last packet";
        actual.resize(2);
        EXPECT_TRUE(same_bits(actual, expected.gather(gatherer)));
    });
}

/// A VPL without light, which reaches nothing.
Vpl dark() {
    return Vpl{};
}

TEST_F(GathererTest, WhatIsNotFiniteAddsNothing) {
    const GatherCase clean = random_triangles(100, 100, 3, 12);
    GatherCase dirty = clean;
    GatherCase without = clean;
    const float nan = std::nanf("");
    const float infinity = std::numeric_limits<float>::infinity();
    for (const std::size_t i : {0, 9, 20, 33, 41, 99}) {
        without.vpls[i] = dark();
    }
    dirty.vpls[0].position.y = nan;
    dirty.vpls[9].normal.x = nan;
    dirty.vpls[20].power.z = nan;
    dirty.vpls[33].power.x = infinity;
    dirty.vpls[41].position.x = infinity;
    dirty.vpls[99].position = {1e38f, -1e38f, 1e38f};
    dirty.receivers[1].px[3] = nan;
    dirty.receivers[1].ny[17] = nan;
    dirty.receivers[2].pz[63] = infinity;
    for (const auto& [packet, lane] : {std::pair{1, 3}, {1, 17}, {2, 63}}) {
        without.receivers[packet].nx[lane] = 0.0f;
        without.receivers[packet].ny[lane] = 0.0f;
        without.receivers[packet].nz[lane] = 0.0f;
    }
    on_each_device([&](Device& device) {
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Gatherer gatherer(device, variant.config);
            EXPECT_TRUE(same_bits(Uploaded(device, dirty).gather(gatherer),
                                  Uploaded(device, without).gather(gatherer)));
        }
    });
}

TEST_F(GathererTest, AbsentReceiversGetNothing) {
    GatherCase data = random_triangles(10, 50, 2, 13);
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        if (i % 3 == 0) {
            data.receivers[0].nx[i] = data.receivers[0].ny[i] = data.receivers[0].nz[i] = 0.0f;
        }
        data.receivers[1].nx[i] = data.receivers[1].ny[i] = data.receivers[1].nz[i] = 0.0f;
    }
    on_each_device([&](Device& device) {
        for (const Variant& variant : variants()) {
            Gatherer gatherer(device, variant.config);
            const std::vector<IrradiancePacket> result = Uploaded(device, data).gather(gatherer);
            for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
                EXPECT_TRUE(i % 3 != 0 || result[0].g[i] == 0.0f) << variant.name << ", lane " << i;
                EXPECT_EQ(result[1].g[i], 0.0f) << variant.name << ", lane " << i;
            }
        }
    });
}

TEST_F(GathererTest, RefusesAnOddBeamWidth) {
    on_each_device([&](Device& device) {
        EXPECT_THROW(Gatherer(device, {GatherKernel::packets, 48}), Error);
    });
}

}  // namespace
}  // namespace nearlight::core::test
