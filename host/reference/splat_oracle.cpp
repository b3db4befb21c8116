// SPDX-License-Identifier: Apache-2.0
#include "host/reference/splat_oracle.h"

#include <array>
#include <cmath>

namespace nearlight::core {
namespace {

/// The filter as its table has it, up to a constant factor, `x` pixels from the middle of a pixel.
double tabled_filter(const Camera& camera, double x) {
    const double place = std::abs(x) / double{camera.filter_radius} * NEARLIGHT_FILTER_CELLS;
    if (!(place < NEARLIGHT_FILTER_CELLS)) {
        return 0.0;
    }
    const auto cell = static_cast<std::size_t>(place);
    return double{camera.filter_signed[cell + 1]} - double{camera.filter_signed[cell]};
}

std::array<double, 3> rgb_of(Vec3 v) {
    return {v.x, v.y, v.z};
}

/// Adds the light of all branches of a sample.
void add_sample(const FilmSamples& samples, const FilmLayout& layout, uint x, uint y, uint sample,
                double weight, double (&direct)[3], double (&indirect)[3]) {
    for (uint branch = 0; branch < layout.branches; ++branch) {
        const auto [packet, lane] = place_of(layout, x, y, sample, branch);
        const BranchLight light = branch_light(samples, packet, lane);
        for (std::size_t c = 0; c < 3; ++c) {
            direct[c] += weight * light.direct[c];
            indirect[c] += weight * light.indirect[c];
        }
    }
}

}  // namespace

FilmSamples random_splat_samples(const FilmLayout& layout) {
    FilmSamples samples = random_film_samples(layout);
    for (CameraVertex& vertex : samples.vertices) {
        vertex.filter_weight = 1.0f + 0.25f * vertex.film_x;
    }
    return samples;
}

SplattedLight expected_splatted_light(const FilmSamples& samples, const FilmLayout& layout,
                                      const Camera& camera, uint x, uint y) {
    SplattedLight light;
    double weights = 0.0;
    double half_weights = 0.0;
    for (uint from_y = 0; from_y < layout.height; ++from_y) {
        for (uint from_x = 0; from_x < layout.width; ++from_x) {
            const double columns = static_cast<double>(from_x) - static_cast<double>(x);
            const double rows = static_cast<double>(from_y) - static_cast<double>(y);
            for (uint sample = 0; sample < layout.samples; ++sample) {
                const auto [packet, lane] = place_of(layout, from_x, from_y, sample, 0);
                const CameraVertex& vertex = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
                const double weight = double{vertex.filter_weight} *
                                      tabled_filter(camera, columns + double{vertex.film_x}) *
                                      tabled_filter(camera, rows + double{vertex.film_y});
                add_sample(samples, layout, from_x, from_y, sample, weight, light.direct, light.indirect);
                weights += weight;
                light.coverage += vertex.depth > 0.0f ? weight : 0.0;
                if (sample < layout.samples / 2) {
                    add_sample(samples, layout, from_x, from_y, sample, weight, light.half, light.half);
                    half_weights += weight;
                }
            }
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
        light.direct[c] /= weights;
        light.indirect[c] /= weights;
        light.half[c] /= half_weights;
    }
    light.coverage /= weights;
    return light;
}

SplattedLight light_of_splats(std::span<const RowSplat> rows, const FilmLayout& layout, uint reach, uint x,
                              uint y) {
    SplattedLight light;
    double weight = 0.0;
    double half_weight = 0.0;
    double camera[3] = {};
    double camera_weight = 0.0;
    for (uint dy = 0; dy < splat_rows(reach); ++dy) {
        const int from = static_cast<int>(y) + static_cast<int>(reach) - static_cast<int>(dy);
        if (from < 0 || from >= static_cast<int>(layout.height)) {
            continue;
        }
        const RowSplat& row =
            rows[(static_cast<std::size_t>(from) * layout.width + x) * splat_rows(reach) + dy];
        for (std::size_t c = 0; c < 3; ++c) {
            light.direct[c] += rgb_of(row.all.direct)[c];
            light.indirect[c] += rgb_of(row.all.indirect)[c];
            light.half[c] += rgb_of(row.all.half_light)[c];
            camera[c] += rgb_of(row.camera.first)[c] + rgb_of(row.camera.second)[c];
        }
        weight += double{row.all.weight};
        light.coverage += double{row.all.coverage};
        half_weight += double{row.all.half_weight};
        camera_weight += double{row.camera.first_weight} + double{row.camera.second_weight};
    }
    for (std::size_t c = 0; c < 3; ++c) {
        light.direct[c] = light.direct[c] / weight + (camera_weight > 0.0 ? camera[c] / camera_weight : 0.0);
        light.indirect[c] /= weight;
        light.half[c] /= half_weight;
    }
    light.coverage /= weight;
    return light;
}

}  // namespace nearlight::core
