// SPDX-License-Identifier: Apache-2.0
#include "host/scene/environment_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "host/scene/environment_map.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using small_scenes::patterned_map;

Scene scene_below(const EnvironmentLight& environment) {
    Scene scene;
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 0, 2}}) {
        scene.vertices.push_back({p, 0, {0, 0, 0}, 0});
    }
    scene.materials.resize(1, Material{});
    scene.triangles = {{0, 1, 2, 0}};
    scene.environment = environment;
    return scene;
}

double step(const std::vector<float>& cdf, std::size_t begin, std::size_t i) {
    return double{cdf[begin + i]} - (i > 0 ? double{cdf[begin + i - 1]} : 0.0);
}

/// The probability with which the tables choose a pixel, where a block without details is chosen evenly.
double probability_of_pixel(const EnvironmentTable& table, std::size_t x, std::size_t y) {
    const Environment& map = table.parameters;
    const std::size_t column = x / map.block_size;
    const std::size_t row = y / map.block_size;
    const std::size_t first_x = column * map.block_size;
    const std::size_t first_y = row * map.block_size;
    const std::size_t columns = std::min<std::size_t>(map.block_size, map.width - first_x);
    const std::size_t rows = std::min<std::size_t>(map.block_size, map.height - first_y);
    const double of_block =
        step(table.row_cdf, 0, row) * step(table.column_cdf, row * map.block_columns, column);
    const uint detail = table.block_details[row * map.block_columns + column];
    if (detail == NEARLIGHT_NO_DETAIL) {
        const auto cosine = [&](std::size_t i) { return double{table.row_cosines[i]}; };
        return of_block * (cosine(y) - cosine(y + 1)) / (cosine(first_y) - cosine(first_y + rows)) /
               static_cast<double>(columns);
    }
    return of_block * step(table.detail_cdf, detail, y - first_y) *
           step(table.detail_cdf, detail + rows + (y - first_y) * columns, x - first_x);
}

/// Luminance of a pixel times the solid angle of the pixels of its row, up to a factor.
double weight_of_pixel(const EnvironmentLight& environment, int x, int y) {
    return double{luminance(environment.radiance[static_cast<std::size_t>(y * environment.width + x)])} *
           (std::cos(std::numbers::pi * y / environment.height) -
            std::cos(std::numbers::pi * (y + 1) / environment.height));
}

double total_weight(const EnvironmentLight& environment) {
    double total = 0;
    for (int i = 0; i < environment.width * environment.height; ++i) {
        total += weight_of_pixel(environment, i % environment.width, i / environment.width);
    }
    return total;
}

TEST(EnvironmentTable, AFewPixelsAreBlocksOfTheirOwn) {
    EnvironmentLight environment = patterned_map(9, 6);
    for (int column = 0; column < 9; ++column) {
        environment.radiance[2 * 9 + column] = {0, 0, 0};  // a dark row
    }
    const EnvironmentTable table = build_environment_table(scene_below(environment));
    EXPECT_EQ(table.parameters.block_size, 1u);
    ASSERT_EQ(table.row_cdf.size(), 6u);
    ASSERT_EQ(table.column_cdf.size(), 54u);
    const double total = total_weight(environment);
    for (int i = 0; i < 54; ++i) {
        EXPECT_NEAR(probability_of_pixel(table, i % 9, i / 9),
                    weight_of_pixel(environment, i % 9, i / 9) / total, 1e-5);
    }
    EXPECT_EQ(table.row_cdf[5], 1.0f);
    EXPECT_EQ(table.row_cdf[2], table.row_cdf[1]);
}

TEST(EnvironmentTable, ASmoothSkyNeedsNoDetails) {
    EnvironmentLight environment = patterned_map(1024, 512);
    for (int i = 0; i < 1024 * 512; ++i) {
        const float height = 1.0f - static_cast<float>(i / 1024) / 512.0f;
        environment.radiance[i] = {height, height, height};
    }
    const EnvironmentTable table = build_environment_table(scene_below(environment));
    EXPECT_EQ(table.parameters.block_columns, 128u);
    EXPECT_EQ(table.parameters.block_rows, 64u);
    EXPECT_EQ(table.block_details, std::vector<uint>(128 * 64, NEARLIGHT_NO_DETAIL));
}

TEST(EnvironmentTable, ASmallSunIsChosenPixelByPixel) {
    EnvironmentLight environment = patterned_map(403, 131);
    environment.radiance.assign(environment.radiance.size(), {0.1f, 0.1f, 0.1f});
    environment.radiance[40 * 403 + 130] = environment.radiance[130 * 403 + 402] = {1e4f, 1e4f, 1e4f};
    const EnvironmentTable table = build_environment_table(scene_below(environment));
    EXPECT_EQ(table.parameters.block_size, 4u);
    const auto details =
        std::ranges::count_if(table.block_details, [](uint detail) { return detail != NEARLIGHT_NO_DETAIL; });
    EXPECT_EQ(details, 2);
    const double total = total_weight(environment);
    double sum = 0;
    for (int i = 0; i < 403 * 131; ++i) {
        sum += probability_of_pixel(table, i % 403, i / 403);
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    for (const auto& [x, y] : {std::pair{130, 40}, {402, 130}, {3, 70}}) {
        const double expected = weight_of_pixel(environment, x, y) / total;
        EXPECT_NEAR(probability_of_pixel(table, x, y), expected, 1e-5 + 1e-3 * expected);
    }
}

TEST(EnvironmentTable, NoDirectionThatShinesIsLeftOut) {
    EnvironmentLight environment = patterned_map(300, 40);
    environment.is_interpolated = true;
    environment.radiance.assign(environment.radiance.size(), {0, 0, 0});
    environment.radiance[20 * 300] = {1, 1, 1};
    const EnvironmentTable table = build_environment_table(scene_below(environment));
    for (const int y : {19, 20, 21}) {
        for (const int x : {299, 0, 1}) {
            EXPECT_GT(probability_of_pixel(table, x, y), 0.0);
        }
    }
}

TEST(EnvironmentTable, PixelsAndFrame) {
    Scene scene = scene_below(patterned_map(2, 1));
    scene.environment.to_world = rotation(0, 1, 0, 90);
    const EnvironmentTable table = build_environment_table(scene);
    EXPECT_EQ(table.parameters.width, 2u);
    EXPECT_EQ(table.parameters.height, 1u);
    ASSERT_EQ(table.pixels.size(), 8u);
    EXPECT_FLOAT_EQ(table.pixels[4], 0.1f);
    EXPECT_FLOAT_EQ(table.pixels[5], 1.0f);
    EXPECT_FLOAT_EQ(table.pixels[6], 0.5f);
    const float* m = table.parameters.world_to_local;  // takes world +X to local +Z
    EXPECT_NEAR(m[0], 0.0f, 1e-6f);
    EXPECT_NEAR(m[6], 1.0f, 1e-6f);
}

TEST(EnvironmentMap, OfFewPixelsHasTheirRadiance) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {4u, 1u}, {1u, 3u}, {4u, 3u}}) {
        const MapShape shape{.width = width, .height = height, .is_interpolated = true};
        for (const Vec3 direction :
             {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0.6f, 0, -0.8f}, Vec3{0.6f, 0.8f, 0}}) {
            const Vec3 radiance = map_radiance(shape, direction, [&](const MapPixel& pixel) {
                EXPECT_LT(pixel.column, width);
                EXPECT_LT(pixel.row, height);
                return Vec3{1, 2, 3};
            });
            EXPECT_NEAR(radiance.x, 1.0f, 1e-6f) << width << "x" << height;
            EXPECT_NEAR(radiance.z, 3.0f, 3e-6f) << width << "x" << height;
        }
    }
}

TEST(EnvironmentTable, WithoutEnvironmentThereIsOneBlackPixel) {
    const EnvironmentTable table = build_environment_table(scene_below({}));
    EXPECT_EQ(table.parameters.width, 0u);
    EXPECT_EQ(table.pixels, std::vector<float>(4, 0.0f));
    EXPECT_EQ(table.row_cdf, std::vector<float>{1.0f});
    EXPECT_EQ(table.column_cdf, std::vector<float>{1.0f});
    EXPECT_FLOAT_EQ(table.parameters.scene_center.x, 1.0f);
}

}  // namespace
}  // namespace nearlight::core
