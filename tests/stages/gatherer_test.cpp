// SPDX-License-Identifier: Apache-2.0
#include "host/stages/gatherer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/bvh/bvh.h"
#include "host/bvh/segment_distance.h"
#include "host/bvh/wide_bvh.h"
#include "tests/support/device_fixture.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

struct Variant {
    std::string name;
    GatherConfig config;
};

std::vector<Variant> variants() {
    return {
        {"packets of 256", {GatherKernel::packets, 256}}, {"packets of 128", {GatherKernel::packets, 128}},
        {"packets of 64", {GatherKernel::packets, 64}},   {"packets of 32", {GatherKernel::packets, 32}},
        {"packets of 16", {GatherKernel::packets, 16}},   {"rays", {GatherKernel::rays, 64}}};
}

/// How the pairs came out that kernel and host see differently.
struct Differences {
    std::size_t rays = 0;
    std::size_t culling = 0;    ///< one culls, though no cosine is near zero
    std::size_t at_edges = 0;   ///< visibility differs, and the segment passes an edge within the tolerance
    std::size_t elsewhere = 0;  ///< visibility differs for no such reason
};

Differences compare(const GatherCase& data, const std::vector<GatherPair>& pairs) {
    // Of the extent of the scene.
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

void expect_close(const std::vector<IrradiancePacket>& actual,
                  const std::vector<IrradiancePacket>& expected) {
    for (std::size_t p = 0; p < expected.size(); ++p) {
        for (std::size_t i = 0; i < 3 * NEARLIGHT_PACKET_SIZE; ++i) {
            const float want = (&expected[p].r[0])[i];
            // All terms are positive, so rounding stays relative; cosines near zero lose some digits.
            ASSERT_NEAR((&actual[p].r[0])[i], want, 2e-5f * want + 1e-9f) << "packet " << p << " entry " << i;
        }
    }
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

// Points on a grid that the triangles share: segments run along edges, through corners and inside planes,
// where either answer is right.
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

/// Without light or geometry that could reach anything.
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

/// The sums of squares, by VPLs that are marked for them.
std::vector<IrradiancePacket> gather_squares(Device& device, Gatherer& gatherer, GatherCase data) {
    for (Vpl& vpl : data.vpls) {
        vpl.power = (1.0f / kPi) * vpl.power * vpl.power;
        vpl.flags = NEARLIGHT_IMPORTON_SQUARED;
    }
    return Uploaded(device, data).gather(gatherer);
}

TEST_F(GathererTest, GroupsAreSummedByThemselves) {
    constexpr uint kGroup = 48;
    const GatherCase data = random_triangles(100, 200, 5, 21);  // the last group has 8
    on_each_device([&](Device& device) {
        const Uploaded uploaded(device, data);
        GatherInput<Vpl> input = uploaded.input();
        input.group_size = kGroup;
        ASSERT_EQ(input.group_count(), 5u);
        for (Variant variant : variants()) {
            for (const double launch_seconds : {1e-9, 1.0}) {
                SCOPED_TRACE(variant.name);
                variant.config.first_launch_pairs = launch_seconds < 1.0 ? 1 : std::uint64_t{1} << 40u;
                variant.config.launch_seconds = launch_seconds;
                Gatherer gatherer(device, variant.config);
                GatherSums<Vpl> sums(device, data.receivers.size(), input.group_count());
                ASSERT_TRUE(gatherer.gather(input, sums));
                expect_close(sums.squares.download(), gather_squares(device, gatherer, data));
                const std::vector<IrradiancePacket> groups = sums.groups.download();
                const auto sum_of = [&](std::size_t group) {
                    const auto first =
                        groups.begin() + static_cast<std::ptrdiff_t>(group * data.receivers.size());
                    return std::vector(first, first + static_cast<std::ptrdiff_t>(data.receivers.size()));
                };
                for (std::size_t group = 0; group < input.group_count(); ++group) {
                    GatherCase of_group = data;
                    const auto first = data.vpls.begin() + static_cast<std::ptrdiff_t>(group * kGroup);
                    of_group.vpls.assign(first, std::min(first + kGroup, data.vpls.end()));
                    EXPECT_TRUE(same_bits(sum_of(group), Uploaded(device, of_group).gather(gatherer)))
                        << "group " << group;
                }
            }
        }
    });
}

/// Of a pair, the square that GatherInput::thresholds is compared with.
double squared_light(const Vpl& vpl, const PairTerm& term) {
    const Vec3 scale = (1.0f / kPi) * vpl.power;
    const bool squared = (vpl.flags & NEARLIGHT_IMPORTON_SQUARED) != 0;
    return term.value * term.value *
           static_cast<double>(squared ? scale.x + scale.y + scale.z : dot(scale, scale));
}

/// For each receiver the mean over all VPLs.
std::vector<float> mean_squares(const GatherCase& data) {
    std::vector<float> means;
    for (std::size_t i = 0; i < data.receivers.size() * NEARLIGHT_PACKET_SIZE; ++i) {
        double sum = 0;
        for (const Vpl& vpl : data.vpls) {
            sum += squared_light(vpl, pair_term(vpl, receiver_at(data.receivers, i), data.clamp_radius));
        }
        means.push_back(static_cast<float>(sum / static_cast<double>(data.vpls.size())));
    }
    return means;
}

TEST_F(GathererTest, LeavesOutWhatIsBelowTheThreshold) {
    GatherCase data = random_triangles(200, 90, 5, 23);
    for (std::size_t i = 0; i < data.vpls.size(); i += 3) {
        data.vpls[i].flags = NEARLIGHT_IMPORTON_SQUARED;
    }
    const std::vector<float> thresholds = mean_squares(data);
    on_each_device([&](Device& device) {
        Uploaded uploaded(device, data);
        const Buffer<float> on_device(device, thresholds);
        GatherInput<Vpl> input = uploaded.input();
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(variant.name);
            Gatherer gatherer(device, variant.config);
            input.thresholds = nullptr;
            const std::vector<GatherPair> all = gatherer.gather_recorded(input, uploaded.sums());
            input.thresholds = &on_device;
            const std::vector<GatherPair> some = gatherer.gather_recorded(input, uploaded.sums());
            std::size_t left_out = 0;
            std::size_t left = 0;
            for (std::size_t i = 0; i < all.size(); ++i) {
                const Vpl& vpl = data.vpls[i / NEARLIGHT_PACKET_SIZE % data.vpls.size()];
                const std::size_t receiver =
                    i / NEARLIGHT_PACKET_SIZE / data.vpls.size() * NEARLIGHT_PACKET_SIZE +
                    i % NEARLIGHT_PACKET_SIZE;
                const double square = squared_light(
                    vpl, pair_term(vpl, receiver_at(data.receivers, receiver), data.clamp_radius));
                if (all[i] == GatherPair::culled || std::abs(square - thresholds[receiver]) < 1e-4 * square) {
                    continue;
                }
                const bool counts = square >= thresholds[receiver];
                ++(counts ? left : left_out);
                ASSERT_EQ(some[i], counts ? all[i] : GatherPair::culled) << "pair " << i;
            }
            EXPECT_GT(left, all.size() / 50);
            EXPECT_GT(left_out, left);
            const std::vector<IrradiancePacket> recorded = uploaded.sums().light.download();
            EXPECT_TRUE(gatherer.gather(input, uploaded.sums()));
            expect_close(uploaded.sums().light.download(), recorded);
        }
    });
}

TEST_F(GathererTest, RefusesASelectionByGroups) {
    const GatherCase data = random_triangles(100, 20, 1, 22);
    on_each_device([&](Device& device) {
        Uploaded uploaded(device, data);
        const VplSelection selection = uploaded.select(1.0f, 0);
        GatherInput<Vpl> input = uploaded.input();
        input.group_size = 10;
        input.selection = &selection;
        Gatherer gatherer(device);
        EXPECT_THROW(gatherer.gather(input, uploaded.sums()), Error);
    });
}

TEST_F(GathererTest, RefusesAnOddBeamWidth) {
    on_each_device([&](Device& device) {
        EXPECT_THROW(Gatherer(device, {GatherKernel::packets, 48}), Error);
    });
}

}  // namespace
}  // namespace nearlight::core::test
