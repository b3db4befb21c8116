// SPDX-License-Identifier: Apache-2.0
#include "host/session/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "host/session/band_progress.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

class PlanTest : public test::DeviceTest {};

/// Checks that each row of tiles is rendered exactly once with each sample.
void expect_all_once(const RenderPlan& plan) {
    std::vector<uint> times(std::size_t{plan.tile_row_count} * plan.samples_per_pixel);
    for (uint band = 0; band < plan.band_count(); ++band) {
        for (const CameraBatch& batch : plan.batches(band)) {
            for (uint row = 0; row < batch.tile_row_count; ++row) {
                for (uint sample = 0; sample < batch.sample_count; ++sample) {
                    ++times.at(std::size_t{batch.first_tile_row + row} * plan.samples_per_pixel +
                               batch.first_sample + sample);
                }
            }
        }
    }
    EXPECT_EQ(times, std::vector<uint>(times.size(), 1));
}

TEST_F(PlanTest, EveryRowHasEverySampleOnce) {
    on_each_device([](Device& device) {
        for (const uint height : {1u, 8u, 9u, 60u, 480u, 1081u, 5000u}) {
            for (const uint samples : {1u, 3u, 64u, 1000u}) {
                SCOPED_TRACE(testing::Message() << height << " rows, " << samples << " samples");
                for (const uint strata : {1u, 3u, samples}) {
                    const PictureSize wide{640, height, samples, 2, strata};
                    const PictureSize narrow{33, height, samples, 1, strata};
                    expect_all_once(make_plan(std::vector{receivers_per_batch(device)}, wide));
                    expect_all_once(make_plan(std::vector(2, receivers_per_batch(device)), narrow));
                }
            }
        }
    });
}

TEST_F(PlanTest, FirstBandIsShort) {
    on_each_device([](Device& device) {
        const RenderPlan plan = make_plan(std::vector{receivers_per_batch(device)}, {640, 480, 4, 2, 1});
        EXPECT_EQ(plan.batches(1).front().first_tile_row, plan.batches(0).front().tile_row_count);
        if (device.is_cpu()) {  // other devices may need all rows for full load
            EXPECT_EQ(plan.batches(0).front().tile_row_count, 1u);
            EXPECT_GT(plan.batches(1).front().tile_row_count, 1u);
        }
    });
}

/// The progress of a picture is that of its work: bands differ in how many rows they have, and rows in what
/// they show.
TEST(BandProgress, GoesByTheWorkOfRows) {
    RenderPlan plan;
    plan.tile_row_count = 16;  // 2, 5, 5 and 4
    plan.tile_rows_in_first = 2;
    plan.tile_rows_per_band = 5;
    plan.cover = {.x = 0, .y = 0, .width = 8, .height = 128};
    ASSERT_EQ(plan.band_count(), 4u);
    double before = 0;
    for (uint band = 0; band < plan.band_count(); ++band) {
        const double rows = plan.batches(band).front().tile_row_count;
        EXPECT_DOUBLE_EQ(part_of_work(plan, 128, {1}, band / 4.0), before / 16) << band;
        EXPECT_DOUBLE_EQ(part_of_work(plan, 128, {1}, (band + 0.25) / 4.0), (before + 0.25 * rows) / 16);
        before += rows;
    }
    // The upper half is a quarter of the work.
    EXPECT_DOUBLE_EQ(part_of_work(plan, 128, {1, 3}, 0.25), 2.0 / 8 * 0.25);
    EXPECT_DOUBLE_EQ(part_of_work(plan, 128, {1, 3}, 0.75), 0.25 + 4.0 / 8 * 0.75);
    EXPECT_DOUBLE_EQ(part_of_work(plan, 128, {1, 3}, 1.0), 1.0);
    // A window that holds the last eight rows of tiles of a picture twice as high.
    plan.cover.y = 128;
    EXPECT_DOUBLE_EQ(part_of_work(plan, 256, {7, 1, 1, 3}, 0.75), (8.0 + 4.0 * 3) / (8.0 + 8.0 * 3));
    plan.tile_row_count = 1;  // a picture of one band, which is shorter than a first one could be
    EXPECT_DOUBLE_EQ(part_of_work(plan, 256, {1}, 0.5), 0.5);
    plan.tile_row_count = 0;
    EXPECT_DOUBLE_EQ(part_of_work(plan, 256, {1}, 1.0), 1.0);
}

/// The lower half of the picture shows a wall; above is the sky.
class StripWorkTest : public test::DeviceTest {};
TEST_F(StripWorkTest, SkyCostsNothing) {
    on_each_device([](Device& device) {
        Scene scene;
        small_scenes::add_quad(
            scene, {-9, -9, 1}, {0, 9, 0}, {18, 0, 0},
            small_scenes::add_material(scene, small_scenes::lambertian({0.5f, 0.5f, 0.5f})));
        small_scenes::set_camera(scene, {0, 0, -1}, {0, 0, 1}, 60);
        scene.camera.width = scene.camera.height = 64;
        const test::SceneOnDevice on_device(device, scene);
        CameraPass camera_pass(device);
        const std::vector<double> work =
            work_of_strips(device, camera_pass, on_device.buffers, scene.camera, {.branch_count = 1}, 1);
        ASSERT_EQ(work.size(), 12u);
        for (std::size_t i = 0; i < work.size(); ++i) {
            EXPECT_NEAR(work[i] / work.back(), i < 6 ? 0.05 / 1.05 : 1.0, 0.01) << i;
        }
    });
}

/// How often each stratum is asked about by the samples of a pixel, over all batches of the first band.
std::vector<uint> times_asked(const RenderPlan& plan, uint seed) {
    std::vector<uint> times(plan.strata);
    for (const CameraBatch& batch : plan.batches(0)) {
        for (const uint stratum : plan.strata_of_bundles(batch, seed)) {
            times.at(stratum) += plan.bundle_samples;
        }
    }
    return times;
}

TEST_F(PlanTest, SamplesShareStrataEvenly) {
    on_each_device([](Device& device) {
        for (const auto& [samples, strata] :
             {std::pair{1u, 1u}, {16u, 1u}, {16u, 2u}, {16u, 4u}, {16u, 16u}, {1024u, 64u}, {6u, 3u}}) {
            for (const uint branches : {1u, 2u}) {
                const RenderPlan plan = make_plan(std::vector{receivers_per_batch(device)},
                                                  {640, 480, samples, branches, strata});
                EXPECT_EQ(times_asked(plan, 3), std::vector<uint>(strata, branches * samples / strata))
                    << samples << " samples, " << strata << " strata";
                EXPECT_EQ(plan.bundle_samples * plan.bundle_columns * plan.bundle_rows,
                          uint{NEARLIGHT_BUNDLE_PACKETS});
            }
        }
    });
}

/// The strata that the first half of a pixel's samples ask about lie at equal distances from one another,
/// whatever the first of them is.
TEST_F(PlanTest, HalfOfTheSamplesAsksStrataThatLieSpread) {
    on_each_device([](Device& device) {
        for (const auto& [samples, strata, distance] :
             {std::tuple{16u, 16u, 2u}, {64u, 16u, 2u}, {64u, 64u, 2u}, {4u, 16u, 8u}, {6u, 24u, 8u}}) {
            for (const uint seed : {1u, 2u, 3u}) {
                const RenderPlan plan =
                    make_plan(std::vector{receivers_per_batch(device)}, {640, 480, samples, 1, strata});
                std::vector<uint> asked;
                for (const CameraBatch& batch : plan.batches(0)) {
                    std::ranges::copy(plan.strata_of_bundles(batch, seed), std::back_inserter(asked));
                }
                asked.resize(asked.size() / 2);
                const std::set<uint> different(asked.begin(), asked.end());
                EXPECT_EQ(different.size(), strata / distance)
                    << samples << " samples, " << strata << " strata";
                for (const uint stratum : different) {
                    EXPECT_EQ(stratum % distance, *different.begin() % distance) << samples << " samples";
                }
            }
        }
    });
}

TEST_F(PlanTest, PixelsOfASquareShareStrata) {
    on_each_device([](Device& device) {
        for (const auto& [samples, strata] : {std::pair{1u, 16u}, {2u, 16u}, {2u, 32u}, {4u, 32u}}) {
            const RenderPlan plan =
                make_plan(std::vector{receivers_per_batch(device)}, {.width = 128,
                                                                     .height = 64,
                                                                     .samples_per_pixel = samples,
                                                                     .strata = strata,
                                                                     .interleave = 4});
            const CameraBatch batch = plan.batches(0).front();
            ASSERT_EQ(batch.sample_count, samples);
            const std::vector<uint> asked = plan.strata_of_bundles(batch, 1);
            std::vector<uint> times(strata);
            // Each pixel of the first square of 4x4: the strata that its samples ask about.
            std::set<std::pair<uint, uint>> pixels_and_strata;
            for (uint y = 0; y < 4; ++y) {
                for (uint x = 0; x < 4; ++x) {
                    for (uint sample = 0; sample < samples; ++sample) {
                        const uint packet =
                            packet_at(packet_order(batch, 128), tile_of_pixel(x, batch.bundle_columns, 4),
                                      tile_of_pixel(y, batch.bundle_rows, 4), sample, 0);
                        const uint stratum = asked[packet / NEARLIGHT_BUNDLE_PACKETS % asked.size()];
                        ++times.at(stratum);
                        pixels_and_strata.insert({stratum, 4 * y + x});
                    }
                }
            }
            EXPECT_EQ(times, std::vector<uint>(strata, 16 * samples / strata)) << strata;
            EXPECT_EQ(pixels_and_strata.size(), strata);  // no two pixels ask about the same
        }
    });
}

// Where samples cannot share the strata evenly, chance makes up for it: over many seeds, each stratum is
// asked about equally often.
TEST_F(PlanTest, SeedsShareStrataEvenly) {
    constexpr uint kPictures = 4000;
    on_each_device([](Device& device) {
        for (const auto& [samples, strata] : {std::pair{1u, 4u}, {6u, 4u}, {5u, 16u}}) {
            const RenderPlan plan =
                make_plan(std::vector{receivers_per_batch(device)}, {64, 48, samples, 1, strata});
            std::vector<double> times(strata);
            for (uint seed = 0; seed < kPictures; ++seed) {
                const std::vector<uint> asked = times_asked(plan, seed);
                std::ranges::transform(asked, times, times.begin(), std::plus<double>());
            }
            const double expected = double{kPictures} * samples / strata;
            for (const double count : times) {
                EXPECT_NEAR(count, expected, 5 * std::sqrt(expected));
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
