// SPDX-License-Identifier: Apache-2.0
#include "host/session/plan.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class PlanTest : public test::DeviceTest {};

/// Checks that each row of tiles is rendered exactly once with each sample.
void expect_all_once(const RenderPlan& plan) {
    std::vector<uint> times(std::size_t{plan.tile_row_count} * plan.samples_per_pixel);
    for (uint band = 0; band < plan.band_count(); ++band) {
        for (const CameraBand& batch : plan.batches(band)) {
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
                expect_all_once(make_plan(std::vector{&device}, 640, height, samples, 2));
                expect_all_once(make_plan(std::vector{&device, &device}, 33, height, samples, 1));
            }
        }
    });
}

TEST_F(PlanTest, FirstBandIsShort) {
    on_each_device([](Device& device) {
        const RenderPlan plan = make_plan(std::vector{&device}, 640, 480, 4, 2);
        EXPECT_EQ(plan.batches(1).front().first_tile_row, plan.batches(0).front().tile_row_count);
        if (device.is_cpu()) {  // other devices may need all rows for full load
            EXPECT_EQ(plan.batches(0).front().tile_row_count, 1u);
            EXPECT_GT(plan.batches(1).front().tile_row_count, 1u);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
