// SPDX-License-Identifier: Apache-2.0
#include "host/scene/environment_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "host/base/division.h"
#include "host/scene/distribution.h"

namespace nearlight::core {
namespace {

/// The maximum numbers of blocks: their table and row distributions fill 64 kB.
constexpr uint kMaxBlockColumns = 128;
constexpr uint kMaxBlockRows = 64;
/// How much the blocks without details may add to the relative variance of the light of a whole sky.
constexpr double kVarianceWithoutDetails = 0.1;

/// Pixels [first, end) of a block.
struct Block {
    std::size_t first_column, end_column, first_row, end_row;
};

Block block_at(const Environment& map, uint column, uint row) {
    const std::size_t x = std::size_t{column} * map.block_size;
    const std::size_t y = std::size_t{row} * map.block_size;
    return {x, std::min<std::size_t>(x + map.block_size, map.width), y,
            std::min<std::size_t>(y + map.block_size, map.height)};
}

void set_blocks(Environment& map) {
    const auto number = [&](uint pixels) { return divide_rounding_up(pixels, map.block_size); };
    map.block_size = 1;
    while (number(map.width) > kMaxBlockColumns || number(map.height) > kMaxBlockRows) {
        map.block_size *= 2;
    }
    map.block_columns = number(map.width);
    map.block_rows = number(map.height);
}

/// What the pixels of a row weigh besides their luminance: the solid angle of each, up to a factor.
double zone_of_row(const EnvironmentTable& table, std::size_t row) {
    return double{table.row_cosines[row]} - double{table.row_cosines[row + 1]};
}

/// Sums over the pixels of a block, weighted by solid angle.
struct BlockSums {
    double solid_angle = 0;
    double weight = 0;
    double squared_weight = 0;
};

BlockSums sums_of_block(const EnvironmentTable& table, std::span<const float> weights, const Block& block) {
    BlockSums sums;
    for (std::size_t row = block.first_row; row < block.end_row; ++row) {
        const double zone = zone_of_row(table, row);
        for (std::size_t column = block.first_column; column < block.end_column; ++column) {
            const double weight = weights[row * table.parameters.width + column];
            sums.solid_angle += zone;
            sums.weight += zone * weight;
            sums.squared_weight += zone * weight * weight;
        }
    }
    return sums;
}

/// What the block adds to the relative variance of the light of the whole sky, which weighs `total`, where
/// its directions are chosen uniformly.
double variance_without_details(const BlockSums& sums, double total) {
    if (!(sums.weight > 0)) {
        return 0.0;
    }
    const double relative_variance = sums.squared_weight * sums.solid_angle / (sums.weight * sums.weight) - 1;
    return sums.weight / total * relative_variance;
}

void add_details(EnvironmentTable& table, std::span<const float> weights, const Block& block) {
    std::vector<double> rows;
    std::vector<float> columns_of_rows;
    for (std::size_t row = block.first_row; row < block.end_row; ++row) {
        const float* first = &weights[row * table.parameters.width + block.first_column];
        const std::vector<double> columns(first, first + (block.end_column - block.first_column));
        rows.push_back(std::accumulate(columns.begin(), columns.end(), 0.0) * zone_of_row(table, row));
        const std::vector<float> cdf = cumulative_distribution(columns);
        columns_of_rows.insert(columns_of_rows.end(), cdf.begin(), cdf.end());
    }
    const std::vector<float> row_cdf = cumulative_distribution(rows);
    table.detail_cdf.insert(table.detail_cdf.end(), row_cdf.begin(), row_cdf.end());
    table.detail_cdf.insert(table.detail_cdf.end(), columns_of_rows.begin(), columns_of_rows.end());
}

void add_distributions(const EnvironmentLight& environment, EnvironmentTable& table) {
    const std::vector<float> weights = pixel_weights(environment);
    const Environment& map = table.parameters;
    std::vector<BlockSums> sums;
    std::vector<double> rows(map.block_rows, 0.0);
    double total = 0;
    for (uint row = 0; row < map.block_rows; ++row) {
        std::vector<double> columns;
        for (uint column = 0; column < map.block_columns; ++column) {
            sums.push_back(sums_of_block(table, weights, block_at(map, column, row)));
            columns.push_back(sums.back().weight);
            rows[row] += sums.back().weight;
        }
        total += rows[row];
        const std::vector<float> cdf = cumulative_distribution(columns);
        table.column_cdf.insert(table.column_cdf.end(), cdf.begin(), cdf.end());
    }
    table.row_cdf = cumulative_distribution(rows);
    const double allowed = kVarianceWithoutDetails / static_cast<double>(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool detailed = map.block_size > 1 && variance_without_details(sums[i], total) > allowed;
        table.block_details.push_back(detailed ? static_cast<uint>(table.detail_cdf.size())
                                               : NEARLIGHT_NO_DETAIL);
        if (detailed) {
            add_details(table, weights,
                        block_at(map, static_cast<uint>(i % map.block_columns),
                                 static_cast<uint>(i / map.block_columns)));
        }
    }
    if (table.detail_cdf.empty()) {
        table.detail_cdf = {1.0f};  // kernels take no buffers without elements
    }
}

Environment sky_around(const Scene& scene) {
    const EnvironmentLight& environment = scene.environment;
    const Sphere sphere = bounding_sphere(scene);
    Environment parameters{};
    parameters.scene_center = sphere.center;
    parameters.scene_radius = sphere.radius;
    parameters.sun_direction = environment.sun_direction;
    parameters.sun_radiance = environment.sun_radiance;
    parameters.sun_height = static_cast<float>(sun_height(environment));
    parameters.sun_half_chord = 2.0f * std::sin(0.5f * environment.sun_half_angle);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {  // the inverse of a rotation is its transpose
            parameters.world_to_local[row * 3 + column] =
                static_cast<float>(environment.to_world(column, row));
        }
    }
    return parameters;
}

}  // namespace

double sun_height(const EnvironmentLight& environment) {
    const double sine = std::sin(0.5 * static_cast<double>(environment.sun_half_angle));
    return 2.0 * sine * sine;
}

std::vector<float> pixel_weights(const EnvironmentLight& environment) {
    const auto width = static_cast<std::size_t>(environment.width);
    const auto height = static_cast<std::size_t>(environment.height);
    std::vector<float> own;
    own.reserve(width * height);
    for (const Vec3 radiance : environment.radiance) {
        own.push_back(std::max(luminance(radiance), 0.0f));
    }
    if (!environment.is_interpolated) {
        return own;
    }
    std::vector<float> weights = own;
    std::vector<float> of_columns(width);  // the sum of a column over three rows
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t above = y > 0 ? y - 1 : y;
        const std::size_t below = std::min(y + 1, height - 1);
        for (std::size_t x = 0; x < width; ++x) {
            of_columns[x] = own[y * width + x];
            of_columns[x] += above < y ? own[above * width + x] : 0.0f;
            of_columns[x] += below > y ? own[below * width + x] : 0.0f;
        }
        for (std::size_t x = 0; x < width; ++x) {
            weights[y * width + x] +=
                (of_columns[(x + width - 1) % width] + of_columns[x] + of_columns[(x + 1) % width]) / 8;
        }
    }
    return weights;
}

EnvironmentTable build_environment_table(const Scene& scene) {
    const EnvironmentLight& environment = scene.environment;
    EnvironmentTable table;
    table.parameters = sky_around(scene);
    if (environment.width == 0 || environment.height == 0) {
        table.pixels.assign(4, 0.0f);
        table.row_cosines = {1.0f, -1.0f};
        table.row_cdf = table.column_cdf = table.detail_cdf = {1.0f};
        table.block_details = {NEARLIGHT_NO_DETAIL};
        return table;
    }
    Environment& map = table.parameters;
    map.width = static_cast<uint>(environment.width);
    map.height = static_cast<uint>(environment.height);
    map.interpolated = environment.is_interpolated ? 1 : 0;
    set_blocks(map);
    table.pixels.reserve(4 * environment.radiance.size());
    for (const Vec3 pixel : environment.radiance) {
        table.pixels.insert(table.pixels.end(), {pixel.x, pixel.y, pixel.z, 1.0f});
    }
    for (uint row = 0; row <= map.height; ++row) {
        table.row_cosines.push_back(static_cast<float>(std::cos(std::numbers::pi * row / map.height)));
    }
    add_distributions(environment, table);
    return table;
}

}  // namespace nearlight::core
