// SPDX-License-Identifier: Apache-2.0
#include "host/compare/tables.h"
#include "tests/compare/methods.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nearlight::core {
namespace {

Cell cell(const Method& method, uint vpls, uint seed, double squared_error, double mean_ratio = 1.0) {
    Cell result{
        .id = {method, vpls, seed}, .close_vpls = vpls - 1, .distant_vpls = 2, .sparse_vpls = 4 + 2 * seed};
    result.error.squared_error = squared_error;
    result.error.mean_ratio = mean_ratio;
    result.error.mean_error = {mean_ratio - 1.0, mean_ratio - 1.0, mean_ratio - 1.0};
    result.generate_seconds = 1.0 + 10.0 * seed;
    result.gather_seconds = 0.5;
    return result;
}

CompareSettings two_methods() {
    CompareSettings settings;
    settings.methods = {kWalks, default_method()};
    settings.vpl_counts = {100, 400};
    settings.seed_count = 3;
    return settings;
}

std::vector<Cell> cells_with(double walks_ratio) {
    std::vector<Cell> cells;
    for (const CellId& id : cells_of(two_methods())) {
        const bool walks = id.method == kWalks;
        const double spread = 0.001 * (static_cast<double>(id.seed) - 1.0);
        cells.push_back(cell(id.method, id.vpls, id.seed, (walks ? 4.0 : 1.0) / id.vpls,
                             (walks ? walks_ratio : 1.0) + spread));
    }
    return cells;
}

TEST(EqualVplsTable, HasARowForEachMethodAndCount) {
    const auto rows = equal_vpls_rows(two_methods(), cells_with(1.0));
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].method, kWalks);
    EXPECT_EQ(rows[1].method, default_method());
    EXPECT_EQ(rows[0].vpls, 100u);
    EXPECT_EQ(rows[2].vpls, 400u);
    EXPECT_EQ(rows[0].gathered_vpls, 101.0);
    EXPECT_EQ(rows[0].sparse_vpls, 6.0);
    EXPECT_NEAR(rows[0].rmse.value, 0.2, 1e-12);
    EXPECT_NEAR(rows[3].rmse.value, 0.05, 1e-12);
    EXPECT_NEAR(rows[2].rmse_ratio, 2.0, 1e-12);
    EXPECT_EQ(rows[1].rmse_ratio, 1.0);
    EXPECT_EQ(rows[0].generate_seconds, 11.0);  // the median
    EXPECT_EQ(rows[0].gather_seconds, 0.5);
    EXPECT_NEAR(rows[0].mean_ratio.half_width, 4.30265 * 0.001 / std::sqrt(3.0), 1e-6);
}

TEST(Curves, AreByGatheredVplsAndWholeTime) {
    const auto rows = equal_vpls_rows(two_methods(), cells_with(1.0));
    const auto curves = curves_of(two_methods(), rows);
    ASSERT_EQ(curves.size(), 2u);
    ASSERT_EQ(curves[1].points.size(), 2u);
    EXPECT_EQ(curves[1].points[1].vpls, 401.0);
    EXPECT_EQ(curves[1].points[1].seconds, 11.5);
    EXPECT_FALSE(curves[0].biased);
    EXPECT_EQ(curves[0].floor, 0.0);
}

TEST(Curves, LostLightIsABiasAndAFloor) {
    const auto rows = equal_vpls_rows(two_methods(), cells_with(0.7));
    const auto curves = curves_of(two_methods(), rows);
    EXPECT_TRUE(curves[0].biased);
    EXPECT_FALSE(curves[1].biased);
    EXPECT_NEAR(curves[0].floor, 0.3, 0.005);
    EXPECT_LT(curves[0].floor, 0.3);
}

TEST(Curves, ThePolicyOfThePaperIsKnownToBeBiased) {
    CompareSettings settings = two_methods();
    settings.methods = {{SamplerKind::close_range, Policy::paper}};
    settings.baseline = settings.methods.front();
    std::vector<Cell> cells;
    for (const CellId& id : cells_of(settings)) {
        cells.push_back(cell(id.method, id.vpls, id.seed, 1.0));
    }
    EXPECT_TRUE(curves_of(settings, equal_vpls_rows(settings, cells)).front().biased);
}

TEST(NoiseRemark, SpeaksUpFromAThirdOfTheSmallestRmseOn) {
    const auto rows = equal_vpls_rows(two_methods(), cells_with(1.0));  // the smallest RMSE is 0.05
    Reference reference{.picture = {}, .method = "path tracing", .samples = 100};
    EXPECT_NE(noise_remark(reference, rows).find("unknown"), std::string::npos);
    reference.noise = {.known = true, .mean_variance = 0.016 * 0.016};
    EXPECT_EQ(noise_remark(reference, rows), "");
    reference.noise.mean_variance = 0.05 * 0.05;
    EXPECT_NE(noise_remark(reference, rows).find("about 900 samples"), std::string::npos)
        << noise_remark(reference, rows);
}

}  // namespace
}  // namespace nearlight::core
