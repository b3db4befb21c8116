// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/candidates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/base/packed_direction.h"
#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using test::divided_room;
using test::SamplingBench;

constexpr uint kCandidates = 3000;
constexpr std::size_t kWanted = 100;

class CandidatesTest : public test::DeviceTest {};

TEST_F(CandidatesTest, ErrorsAreNotBelowThoseOfThePartsOfThePicture) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const std::vector<Vpl> vpls =
            bench.sample(SamplerKind::instant_radiosity, kCandidates, 1).vpls.download();
        const JudgedCandidates judged =
            judge(bench.stages(), bench.task(SamplerKind::close_range, kWanted, 1), vpls);
        ASSERT_EQ(judged.weights.size(), vpls.size());
        const std::size_t row_length = judged.rows.size() / vpls.size();
        ASSERT_EQ(row_length, 3 * bench.view().importon_groups.group_count);
        uint seen = 0;
        for (std::size_t i = 0; i < vpls.size(); ++i) {
            double square = 0;
            for (std::size_t k = 0; k < row_length; ++k) {
                square += std::pow(judged.rows[i * row_length + k], 2.0);
            }
            seen += square > 0 ? 1 : 0;
            // Within each group, whose rows are divided by √n, (Σ c)² ≤ n Σ c² holds.
            EXPECT_LE(std::sqrt(square), 1.001 * judged.weights[i]) << "candidate " << i;
            EXPECT_GT(judged.weights[i], 0.0f) << "candidate " << i << " could never be chosen";
        }
        EXPECT_GT(seen, vpls.size() / 4);
    });
}

/// Importons may have overlooked a gap through which a candidate near the camera lights the picture. One far
/// away that faces away does nothing for it, however strong it is.
TEST_F(CandidatesTest, HiddenCandidatesCountByWhatTheyWouldBring) {
    const auto vpl_at = [](Vec3 position, Vec3 normal, float power) {
        Vpl vpl{};
        vpl.position = position;
        vpl.normal = normal;
        vpl.shading = pack_direction(normal);
        vpl.power = {power, power, power};
        return vpl;
    };
    const std::vector<Vpl> vpls{vpl_at({0, 0.9f, 1}, {0, -1, 0}, 1),      // in the camera's half of the room
                                vpl_at({-0.5f, 0, -0.1f}, {0, 0, 1}, 1),  // behind the divider, facing it
                                vpl_at({0, 0, -50}, {0, 0, -1}, 100)};
    on_each_device([&](Device& device) {
        SamplingBench bench(device, divided_room());
        const SamplingTask task = bench.task(SamplerKind::close_range, kWanted, 1);
        for (const std::vector<float>& weights :
             {choice_weights(bench.stages(), task, vpls, ContributionNorm::error_of_draw),
              judge(bench.stages(), task, vpls).weights}) {
            ASSERT_EQ(weights.size(), vpls.size());
            EXPECT_GT(weights[0], weights[1]);
            EXPECT_GT(weights[1], 0.02f * weights[0]);
            EXPECT_GT(weights[1], 2 * weights[2]) << "for a hundredth of the power";
            EXPECT_GT(weights[2], 0.0f);
        }
    });
}

TEST_F(CandidatesTest, RowsThatWereNotKeptAreFoundAgain) {
    on_each_device([](Device& device) {
        SamplingBench bench(device, divided_room());
        const std::vector<Vpl> vpls =
            bench.sample(SamplerKind::instant_radiosity, kCandidates, 1).vpls.download();
        const SamplingTask task = bench.task(SamplerKind::close_range, kWanted, 1);
        const JudgedCandidates judged = judge(bench.stages(), task, vpls);
        const auto choice = [&](std::span<const float> rows) {
            return choose_balanced(bench.stages(), task, vpls, rows, judged.weights, kWanted, Pcg32(7));
        };
        const Choice with_rows = choice(judged.rows);
        const Choice without = choice({});
        EXPECT_EQ(with_rows.indices, without.indices);
        EXPECT_EQ(with_rows.factors, without.factors);
        EXPECT_NEAR(static_cast<double>(with_rows.indices.size()), kWanted, 0.1 * kWanted);
    });
}

}  // namespace
}  // namespace nearlight::core
