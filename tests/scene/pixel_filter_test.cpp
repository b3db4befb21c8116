// SPDX-License-Identifier: Apache-2.0
#include "host/scene/pixel_filter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace nearlight::core {
namespace {

constexpr std::array kKinds{FilterKind::box,      FilterKind::tent,        FilterKind::gaussian,
                            FilterKind::mitchell, FilterKind::catmull_rom, FilterKind::lanczos};

/// The integral of the filter from 0 to `end`, by Simpson's rule.
double integral(const PixelFilter& filter, double end, bool absolute) {
    constexpr int kSteps = 6000;
    double sum = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double value = filter_value(filter, 0.9999999 * end * i / kSteps);
        sum += (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * (absolute ? std::abs(value) : value);
    }
    return sum * end / kSteps / 3.0;
}

TEST(PixelFilter, HasTheValuesOfItsFormula) {
    const auto value = [](FilterKind kind, double x) { return filter_value(default_filter(kind), x); };
    EXPECT_DOUBLE_EQ(value(FilterKind::box, 0.49), 1.0);
    EXPECT_DOUBLE_EQ(value(FilterKind::box, -0.51), 0.0);
    EXPECT_DOUBLE_EQ(value(FilterKind::tent, -0.25), 0.75);
    EXPECT_NEAR(value(FilterKind::gaussian, 0.5), std::exp(-0.5) - std::exp(-8.0), 1e-12);
    EXPECT_NEAR(value(FilterKind::gaussian, 2.0), 0.0, 1e-12);
    EXPECT_NEAR(value(FilterKind::mitchell, 0.0), 8.0 / 9.0, 1e-12);
    EXPECT_NEAR(value(FilterKind::mitchell, 1.0), 1.0 / 18.0, 1e-12);
    EXPECT_LT(value(FilterKind::mitchell, 1.5), 0.0);
    EXPECT_NEAR(value(FilterKind::catmull_rom, 0.0), 1.0, 1e-12);
    EXPECT_NEAR(value(FilterKind::catmull_rom, 1.0), 0.0, 1e-12);
    EXPECT_NEAR(value(FilterKind::catmull_rom, 1.5), -0.0625, 1e-12);
    EXPECT_NEAR(value(FilterKind::lanczos, 0.5), 6.0 / (std::numbers::pi * std::numbers::pi), 1e-12);
    EXPECT_NEAR(value(FilterKind::lanczos, 2.0), 0.0, 1e-12);
    EXPECT_LT(value(FilterKind::lanczos, 1.5), 0.0);
}

TEST(PixelFilter, CubicsAddUpToOneOverAllPixels) {
    for (const FilterKind kind : {FilterKind::mitchell, FilterKind::catmull_rom}) {
        for (const double x : {0.0, 0.1, 0.37, 0.5, 0.93}) {
            double sum = 0.0;
            for (int pixel = -3; pixel <= 3; ++pixel) {
                sum += filter_value(default_filter(kind), x - pixel);
            }
            EXPECT_NEAR(sum, 1.0, 1e-12) << to_string(kind) << " at " << x;
        }
    }
}

TEST(PixelFilter, TablesHoldItsIntegrals) {
    for (const FilterKind kind : kKinds) {
        const PixelFilter filter = default_filter(kind);
        std::vector<float> absolute(121), with_sign(121);
        fill_filter_tables(filter, absolute, with_sign);
        for (const std::size_t i : {0u, 1u, 40u, 60u, 97u, 120u}) {
            const double end = filter.radius * static_cast<double>(i) / 120.0;
            EXPECT_NEAR(absolute[i], integral(filter, end, true), 3e-5) << to_string(kind) << " " << i;
            EXPECT_NEAR(with_sign[i], integral(filter, end, false), 1e-5) << to_string(kind) << " " << i;
        }
    }
}

TEST(PixelFilter, NamesAreThoseOfMitsuba) {
    EXPECT_EQ(filter_names(), "box, tent, gaussian, mitchell, catmullrom, lanczos");
    for (const FilterKind kind : kKinds) {
        EXPECT_EQ(filter_kind(to_string(kind)), kind);
    }
    EXPECT_FALSE(filter_kind("bicubic"));
}

}  // namespace
}  // namespace nearlight::core
