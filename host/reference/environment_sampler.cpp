// SPDX-License-Identifier: Apache-2.0
#include "host/reference/environment_sampler.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "host/scene/distribution.h"

namespace nearlight::core {
namespace {

/// Index of the first entry above u, or of the last entry if rounding leaves none above.
uint pick_entry(std::span<const float> cdf, float u) {
    const auto found = std::upper_bound(cdf.begin(), cdf.end(), u);
    return static_cast<uint>(std::min(found - cdf.begin(), std::ptrdiff_t(cdf.size()) - 1));
}

double step_of(std::span<const float> cdf, uint i) {
    return i > 0 ? cdf[i] - cdf[i - 1] : cdf[i];
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Scene& scene) : table_(build_environment_table(scene)) {
    if (!exists()) {
        return;
    }
    const std::vector<float> weights = pixel_weights(scene.environment);
    const std::size_t width = table_.parameters.width;
    std::vector<double> rows;
    for (std::size_t row = 0; row < table_.parameters.height; ++row) {
        const std::vector<double> pixels(weights.begin() + static_cast<std::ptrdiff_t>(row * width),
                                         weights.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
        const std::vector<float> cdf = cumulative_distribution(pixels);
        column_cdf_.insert(column_cdf_.end(), cdf.begin(), cdf.end());
        const double zone = double{table_.row_cosines[row]} - double{table_.row_cosines[row + 1]};
        rows.push_back(zone * std::accumulate(pixels.begin(), pixels.end(), 0.0));
    }
    row_cdf_ = cumulative_distribution(rows);
}

Vec3 EnvironmentSampler::sample(float row, Point2 place) const {
    const Environment& parameters = table_.parameters;
    MapPixel pixel;
    pixel.row = pick_entry(row_cdf_, row);
    const std::span columns =
        std::span(column_cdf_).subspan(pixel.row * std::size_t{parameters.width}, parameters.width);
    pixel.column = pick_entry(columns, place.x);
    const float before = pixel.column > 0 ? columns[pixel.column - 1] : 0.0f;
    const float share = columns[pixel.column] - before;
    const float within = share > 0.0f ? std::clamp((place.x - before) / share, 0.0f, 1.0f) : 0.5f;

    const float width = static_cast<float>(parameters.width);
    const float height = static_cast<float>(parameters.height);
    const float azimuth = 2.0f * kPi * (static_cast<float>(pixel.column) + within) / width;
    const float cos_top = std::cos(kPi * static_cast<float>(pixel.row) / height);
    const float cos_bottom = std::cos(kPi * static_cast<float>(pixel.row + 1) / height);
    const float y = cos_top + (cos_bottom - cos_top) * place.y;
    const float sine = std::sqrt(std::max(0.0f, 1.0f - y * y));
    const Vec3 local{std::sin(azimuth) * sine, y, -std::cos(azimuth) * sine};
    const float* m = parameters.world_to_local;  // a rotation, so its transpose is its inverse
    return {m[0] * local.x + m[3] * local.y + m[6] * local.z,
            m[1] * local.x + m[4] * local.y + m[7] * local.z,
            m[2] * local.x + m[5] * local.y + m[8] * local.z};
}

Vec3 EnvironmentSampler::to_local(Vec3 direction) const {
    const float* m = table_.parameters.world_to_local;
    return {m[0] * direction.x + m[1] * direction.y + m[2] * direction.z,
            m[3] * direction.x + m[4] * direction.y + m[5] * direction.z,
            m[6] * direction.x + m[7] * direction.y + m[8] * direction.z};
}

MapShape EnvironmentSampler::shape() const {
    return {.width = table_.parameters.width,
            .height = table_.parameters.height,
            .is_interpolated = table_.parameters.interpolated != 0};
}

double EnvironmentSampler::pixel_density(MapPixel pixel) const {
    const Environment& parameters = table_.parameters;
    const std::span columns =
        std::span(column_cdf_).subspan(pixel.row * std::size_t{parameters.width}, parameters.width);
    const double probability = step_of(row_cdf_, pixel.row) * step_of(columns, pixel.column);
    const double pi = std::numbers::pi;
    const double zone =
        std::cos(pi * pixel.row / parameters.height) - std::cos(pi * (pixel.row + 1) / parameters.height);
    return probability * parameters.width / (2.0 * pi * zone);
}

Vec3 EnvironmentSampler::map_radiance(Vec3 direction) const {
    if (!exists()) {
        return {0, 0, 0};
    }
    return core::map_radiance(shape(), to_local(direction), [this](MapPixel pixel) {
        const float* const rgba =
            &table_.pixels[4 * (pixel.row * std::size_t{table_.parameters.width} + pixel.column)];
        return Vec3{rgba[0], rgba[1], rgba[2]};
    });
}

Vec3 EnvironmentSampler::radiance(Vec3 direction) const {
    const Vec3 map = map_radiance(direction);
    return sun_density(direction) > 0.0 ? map + table_.parameters.sun_radiance : map;
}

double EnvironmentSampler::sun_density(Vec3 direction) const {
    const Environment& parameters = table_.parameters;
    const bool meets = length(direction - parameters.sun_direction) < parameters.sun_half_chord;
    return meets ? 1.0 / (2.0 * std::numbers::pi * parameters.sun_height) : 0.0;
}

Vec3 EnvironmentSampler::sample_sun(Point2 place) const {
    const double cosine = 1.0 - static_cast<double>(place.x) * table_.parameters.sun_height;
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double azimuth = 2.0 * std::numbers::pi * place.y;
    return normalize(
        Frame(table_.parameters.sun_direction)
            .to_world({static_cast<float>(sine * std::cos(azimuth)),
                       static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(cosine)}));
}

double EnvironmentSampler::density(Vec3 direction) const {
    return exists() ? pixel_density(pixel_towards(shape(), to_local(direction))) : 0.0;
}

}  // namespace nearlight::core
