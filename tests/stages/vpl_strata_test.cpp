// SPDX-License-Identifier: Apache-2.0
#include "host/stages/vpl_strata.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "kernels/shared/packet_order.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"
#include "tests/support/gather_scenes.h"
#include "tests/support/spread.h"
#include "tests/support/uploaded_gather.h"

namespace nearlight::core::test {
namespace {

constexpr std::array kKernels{GatherKernel::packets, GatherKernel::rays};

/// All bundles ask about one stratum.
VplStrata one_of(Device& device, uint count, uint stratum) {
    return {device, count, std::vector{stratum}};
}

class VplStrataTest : public DeviceTest {};

TEST_F(VplStrataTest, EachPairBelongsToOneStratum) {
    const GatherCase data = room_of_boxes(40, 101, 6, 31);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : kKernels) {
            Gatherer gatherer(device, {.kernel = kernel});
            Uploaded uploaded(device, data);
            GatherInput<Vpl> input = uploaded.input();
            const std::vector<GatherPair> full = gatherer.gather_recorded(input, uploaded.sums());
            for (const uint count : {1u, 2u, 7u, 300u}) {
                std::vector<int> times(full.size());
                for (uint stratum = 0; stratum < count; ++stratum) {
                    const VplStrata strata = one_of(device, count, stratum);
                    input.strata = &strata;
                    const std::vector<GatherPair> some = gatherer.gather_recorded(input, uploaded.sums());
                    for (std::size_t i = 0; i < full.size(); ++i) {
                        ASSERT_TRUE(some[i] == full[i] || some[i] == GatherPair::culled);
                        times[i] += some[i] != GatherPair::culled ? 1 : 0;
                    }
                }
                for (std::size_t i = 0; i < full.size(); ++i) {
                    ASSERT_EQ(times[i], full[i] != GatherPair::culled ? 1 : 0) << count << " strata";
                }
            }
        }
    });
}

TEST_F(VplStrataTest, MeanOverStrataIsTheFullGather) {
    const GatherCase data = room_of_boxes(40, 700, 6, 32);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : kKernels) {
            Gatherer gatherer(device, {.kernel = kernel});
            Uploaded uploaded(device, data);
            const std::vector<IrradiancePacket> full = uploaded.gather(gatherer);
            for (const uint count : {3u, 16u}) {
                std::vector<double> sums(full.size() * NEARLIGHT_PACKET_SIZE);
                for (uint stratum = 0; stratum < count; ++stratum) {
                    const auto some = uploaded.gather(gatherer, one_of(device, count, stratum));
                    for (std::size_t i = 0; i < sums.size(); ++i) {
                        sums[i] += some[i / NEARLIGHT_PACKET_SIZE].g[i % NEARLIGHT_PACKET_SIZE];
                    }
                }
                for (std::size_t i = 0; i < sums.size(); ++i) {
                    const double expected = full[i / NEARLIGHT_PACKET_SIZE].g[i % NEARLIGHT_PACKET_SIZE];
                    EXPECT_NEAR(sums[i] / count, expected, 2e-5 * expected);
                }
            }
        }
    });
}

TEST_F(VplStrataTest, BundlesAskAboutTheirOwnStratum) {
    const GatherCase data = room_of_boxes(40, 300, 18, 33);
    const std::vector<uint> turns{2, 0, 1};
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : kKernels) {
            Gatherer gatherer(device, {.kernel = kernel});
            Uploaded uploaded(device, data);
            const auto mixed = uploaded.gather(gatherer, VplStrata(device, 3, turns));
            for (uint stratum = 0; stratum < 3; ++stratum) {
                const auto alike = uploaded.gather(gatherer, one_of(device, 3, stratum));
                for (std::size_t p = 0; p < mixed.size(); ++p) {
                    const bool same = std::memcmp(&mixed[p], &alike[p], sizeof(IrradiancePacket)) == 0;
                    EXPECT_EQ(same, turns[p / NEARLIGHT_BUNDLE_PACKETS % 3] == stratum) << "packet " << p;
                }
            }
        }
    });
}

TEST_F(VplStrataTest, LaunchesAndBeamWidthsDoNotChangeABit) {
    const GatherCase data = room_of_boxes(40, 1400, 10, 34);
    on_each_device([&](Device& device) {
        const VplStrata strata(device, 2, std::vector<uint>{1, 0, 0});
        for (const GatherKernel kernel : kKernels) {
            Gatherer gatherer(device, {.kernel = kernel});
            Gatherer step_by_step(
                device,
                {.kernel = kernel, .beam_width = 64, .first_launch_pairs = 1, .launch_seconds = 1e-9});
            EXPECT_TRUE(same_bits(Uploaded(device, data).gather(gatherer, strata),
                                  Uploaded(device, data).gather(step_by_step, strata)));
        }
    });
}

TEST_F(VplStrataTest, RouletteChoosesWithinTheStratum) {
    constexpr uint kDraws = 200;
    const GatherCase data = room_of_boxes(40, 900, 6, 35);
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        const VplStrata strata(device, 3, std::vector<uint>{1, 2});
        const auto sum = [](const std::vector<IrradiancePacket>& light) {
            double total = 0;
            for (const IrradiancePacket& packet : light) {
                total = std::accumulate(packet.g, packet.g + NEARLIGHT_PACKET_SIZE, total);
            }
            return total;
        };
        std::vector<double> sums;
        for (uint seed = 0; seed < kDraws; ++seed) {
            sums.push_back(sum(uploaded.gather(gatherer, 2.0f, seed, &strata)));
        }
        const Spread spread = spread_of(sums);
        const double expected = sum(uploaded.gather(gatherer, strata));
        EXPECT_NEAR(spread.mean, expected, 4.9 * spread.error);
        EXPECT_LT(spread.error, 0.002 * expected) << "too noisy to tell";
    });
}

TEST_F(VplStrataTest, GroupsTakeNoStrata) {
    const GatherCase data = room_of_boxes(4, 30, 2, 36);
    on_each_device([&](Device& device) {
        Gatherer gatherer(device);
        Uploaded uploaded(device, data);
        const VplStrata strata = one_of(device, 2, 0);
        GatherInput<Vpl> input = uploaded.input();
        input.strata = &strata;
        input.group_size = 10;
        EXPECT_TRUE(mentions(error_of([&] { gatherer.gather(input, uploaded.sums()); }), "strata"));
    });
}

TEST(PacketOrderTest, EveryPacketHasAPlaceAndBundlesAreOfOneBranch) {
    for (const PacketOrder& order : {PacketOrder{6, 3, 2, 2, 2, 1, 1}, PacketOrder{6, 4, 1, 2, 1, 2, 1},
                                     PacketOrder{5, 8, 2, 1, 1, 4, 1}, PacketOrder{8, 3, 2, 2, 2, 1, 4}}) {
        const uint rows = 2 * order.bundle_rows;
        std::vector<std::array<uint, 3>> at(std::size_t{order.tile_columns} * rows * order.sample_count *
                                            order.branch_count);
        std::vector<bool> taken(at.size());
        for (uint i = 0; i < at.size(); ++i) {
            const uint branch = i % order.branch_count;
            const uint sample = i / order.branch_count % order.sample_count;
            const uint tile = i / order.branch_count / order.sample_count;
            const uint column = tile % order.tile_columns;
            const uint row = tile / order.tile_columns;
            const uint place = packet_at(order, column, row, sample, branch);
            ASSERT_LT(place, at.size());
            EXPECT_FALSE(taken[place]);
            taken[place] = true;
            at[place] = {branch, sample / order.bundle_samples,
                         row / order.bundle_rows * 100 + column / order.bundle_columns};
        }
        for (std::size_t i = 0; i < at.size(); ++i) {
            EXPECT_EQ(at[i], at[i / NEARLIGHT_BUNDLE_PACKETS * NEARLIGHT_BUNDLE_PACKETS]);
        }
    }
}

TEST(PacketOrderTest, InterleavedTilesShareThePictureAndBundlesThePlaceInASquare) {
    for (const uint interleave : {1u, 2u, 4u}) {
        for (const uint together : {1u, 2u}) {
            for (uint pixel = 0; pixel < 200; ++pixel) {
                const uint tile = tile_of_pixel(pixel, together, interleave);
                const uint lane = lane_of_pixel(pixel, interleave);
                EXPECT_EQ(pixel_of_tile(tile, lane, together, interleave), pixel);
                const uint first_of_bundle = tile / together * together;
                EXPECT_EQ(pixel_of_tile(first_of_bundle, 0, together, interleave) % interleave,
                          pixel % interleave);
            }
        }
    }
}

}  // namespace
}  // namespace nearlight::core::test
