// SPDX-License-Identifier: Apache-2.0
#include "host/session/splat_rows.h"

#include <gtest/gtest.h>

#include <cstring>

#include "host/base/random.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

constexpr uint kRowWidth = 3;
constexpr uint kSamples = 8;

/// A band of rows of random layers and splats.
std::vector<float> random_band(uint rows, uint reach, Pcg32& random) {
    std::vector<float> band(std::size_t{kRowWidth} * rows * band_floats_per_pixel(reach));
    for (float& value : band) {
        value = random.uniform() + 0.1f;
    }
    return band;
}

/// Rows of a band, as a device delivers them: layers first.
std::vector<float> rows_of(const std::vector<float>& band, uint rows, uint reach, uint first, uint count) {
    const std::size_t splats = band_floats_per_pixel(reach) - NEARLIGHT_LAYER_CHANNELS;
    const std::size_t layers_end = std::size_t{kRowWidth} * rows * NEARLIGHT_LAYER_CHANNELS;
    std::vector<float> part;
    for (const auto& [begin, size] :
         {std::pair{std::size_t{0}, std::size_t{NEARLIGHT_LAYER_CHANNELS}}, std::pair{layers_end, splats}}) {
        const auto from = band.begin() + static_cast<std::ptrdiff_t>(begin + first * kRowWidth * size);
        part.insert(part.end(), from, from + static_cast<std::ptrdiff_t>(count * kRowWidth * size));
    }
    return part;
}

/// The rows that come out where bands of so many rows go in.
std::vector<float> finished(const std::vector<float>& band, uint rows, uint reach,
                            const std::vector<uint>& heights) {
    SplatRows splats(kRowWidth, reach, kSamples);
    std::vector<float> result;
    uint first = 0;
    for (const uint height : heights) {
        std::vector<float> part = rows_of(band, rows, reach, first, height);
        splats.take(part);
        result.insert(result.end(), part.begin(), part.end());
        first += height;
    }
    const std::vector<float> last = splats.finish();
    result.insert(result.end(), last.begin(), last.end());
    return result;
}

TEST(SplatRows, BandsDoNotChangeABit) {
    for (const uint reach : {1u, 2u}) {
        Pcg32 random(reach);
        const std::vector<float> band = random_band(11, reach, random);
        const std::vector<float> whole = finished(band, 11, reach, {11});
        EXPECT_EQ(whole.size(), std::size_t{kRowWidth} * 11 * NEARLIGHT_LAYER_CHANNELS);
        EXPECT_EQ(finished(band, 11, reach, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}), whole);
        EXPECT_EQ(finished(band, 11, reach, {8, 3}), whole);
        EXPECT_EQ(finished(band, 11, reach, {1, 9, 1}), whole);
    }
}

TEST(SplatRows, RowsComeWhenAllThatReachThemAreThere) {
    Pcg32 random(3);
    const std::vector<float> band = random_band(8, 2, random);
    SplatRows splats(kRowWidth, 2, kSamples);
    const std::size_t row = std::size_t{kRowWidth} * NEARLIGHT_LAYER_CHANNELS;
    std::vector<std::size_t> counts;
    for (const auto& [first, count] : {std::pair{0u, 2u}, {2u, 1u}, {3u, 5u}}) {
        std::vector<float> part = rows_of(band, 8, 2, first, count);
        splats.take(part);
        counts.push_back(part.size() / row);
    }
    EXPECT_EQ(counts, (std::vector<std::size_t>{0, 1, 5}));
    EXPECT_EQ(splats.finish().size() / row, 2u);
}

TEST(SplatRows, WithoutReachRowsPassUnchanged) {
    Pcg32 random(4);
    const std::vector<float> band = random_band(4, 0, random);
    std::vector<float> rows = band;
    SplatRows splats(kRowWidth, 0, kSamples);
    splats.take(rows);
    EXPECT_EQ(rows, band);
    EXPECT_TRUE(splats.finish().empty());
}

/// One pixel with one row of splats: the layers of light are the sums ÷ the weights, with the camera's light
/// on top, and all other layers stay.
TEST(SplatRows, LightIsDividedByTheWeightsOfItsSamples) {
    std::vector<float> band(band_floats_per_pixel(1), 0.25f);
    std::vector<RowSplat> rows(3, RowSplat{});
    rows[1] = {.all = {.direct = {8, 4, 2},
                       .weight = 4,
                       .indirect = {2, 0, 4},
                       .half_weight = 1,
                       .half_light = {1, 2, 3},
                       .coverage = 3},
               .camera = {.first = {6, 0, 2}, .first_weight = 2, .second = {2, 1, 2}, .second_weight = 6}};
    std::memcpy(band.data() + NEARLIGHT_LAYER_CHANNELS, rows.data(), 3 * sizeof(RowSplat));
    SplatRows splats(1, 1, kSamples);
    splats.take(band);
    EXPECT_TRUE(band.empty());
    const std::vector<float> pixel = splats.finish();
    EXPECT_FLOAT_EQ(pixel[NEARLIGHT_LAYER_DIRECT], 8.0f / 4 + 8.0f / 8);
    EXPECT_FLOAT_EQ(pixel[NEARLIGHT_LAYER_INDIRECT + 2], 4.0f / 4);
    EXPECT_FLOAT_EQ(pixel[NEARLIGHT_LAYER_BEAUTY + 1], 4.0f / 4 + 1.0f / 8);
    const float first = 1.0f + 6.0f / 2;
    const float second = (8.0f + 2.0f - 1.0f) / 3 + 2.0f / 6;
    EXPECT_FLOAT_EQ(pixel[NEARLIGHT_LAYER_VARIANCE],
                    NEARLIGHT_HALVES_TO_WHOLE * 0.25f * (first - second) * (first - second));
    EXPECT_EQ(pixel[NEARLIGHT_LAYER_ALBEDO], 0.25f);
    EXPECT_FLOAT_EQ(pixel[NEARLIGHT_LAYER_ALPHA], 3.0f / 4);
}

TEST(SplatRows, CoverageStaysBetweenNothingAndAll) {
    for (const auto& [coverage, alpha] : {std::pair{-0.5f, 0.0f}, {2.5f, 1.0f}, {1.0f, 0.5f}}) {
        std::vector<float> band(band_floats_per_pixel(1), 0.0f);
        std::vector<RowSplat> rows(3, RowSplat{});
        rows[1].all.weight = 2;
        rows[1].all.coverage = coverage;
        std::memcpy(band.data() + NEARLIGHT_LAYER_CHANNELS, rows.data(), 3 * sizeof(RowSplat));
        SplatRows splats(1, 1, kSamples);
        splats.take(band);
        EXPECT_EQ(splats.finish()[NEARLIGHT_LAYER_ALPHA], alpha);
    }
}

TEST(SplatRows, APixelOfNoWeightIsBlack) {
    std::vector<float> band(band_floats_per_pixel(1), 0.0f);
    const std::vector<RowSplat> rows(3, RowSplat{.all = {.direct = {1, 1, 1},
                                                         .weight = -1,
                                                         .indirect = {},
                                                         .half_weight = 0,
                                                         .half_light = {},
                                                         .coverage = -1},
                                                 .camera = {}});
    std::memcpy(band.data() + NEARLIGHT_LAYER_CHANNELS, rows.data(), 3 * sizeof(RowSplat));
    SplatRows splats(1, 1, kSamples);
    splats.take(band);
    const std::vector<float> pixel = splats.finish();
    EXPECT_EQ(pixel[NEARLIGHT_LAYER_BEAUTY], 0.0f);
    EXPECT_EQ(pixel[NEARLIGHT_LAYER_ALPHA], 0.0f);
}

TEST(SplatRows, FiltersDecideTheReach) {
    const auto reach = [](FilterKind kind, uint samples = 16, bool splat = true) {
        return splat_reach(default_filter(kind), {.samples_per_pixel = samples, .splat = splat});
    };
    EXPECT_EQ(reach(FilterKind::box), 0u);
    EXPECT_EQ(reach(FilterKind::tent), 1u);
    EXPECT_EQ(reach(FilterKind::gaussian), 2u);
    EXPECT_EQ(reach(FilterKind::mitchell), 2u);
    EXPECT_EQ(reach(FilterKind::lanczos), 0u) << "it reaches too far";
    EXPECT_EQ(reach(FilterKind::tent, kMinSplattedSamples), 1u);
    EXPECT_EQ(reach(FilterKind::tent, kMinSplattedSamples - 1), 0u);
    EXPECT_EQ(reach(FilterKind::tent, 16, false), 0u);
}

}  // namespace
}  // namespace nearlight::core
