// SPDX-License-Identifier: Apache-2.0
#include "host/reference/camera_lights_oracle.h"

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace nearlight::core {
namespace {

std::array<double, 3> channels(Vec3 v) {
    return {v.x, v.y, v.z};
}

/// The squared difference of the means of the halves, times what makes it the variance of the mean of all
/// samples.
double variance_of_mean(const CameraLight& light, uint sample_count) {
    const double in_first = sample_count / 2;
    const double in_second = sample_count - in_first;
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        sum += std::pow(channels(light.first)[c] / in_first - channels(light.second)[c] / in_second, 2);
    }
    return sum * in_first * in_second / std::pow(sample_count, 2);
}

double squared_light(std::span<const float> sums, uint sample_count) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double light =
            double{sums[NEARLIGHT_SUM_DIRECT + c]} + double{sums[NEARLIGHT_SUM_INDIRECT + c]};
        sum += std::pow(light / sample_count, 2);
    }
    return sum;
}

bool are_neighbours(uint x, uint y, uint other_x, uint other_y) {
    const auto apart = [](uint a, uint b) { return a > b ? a - b : b - a; };
    const bool same_square = x / NEARLIGHT_TILE_SIZE == other_x / NEARLIGHT_TILE_SIZE &&
                             y / NEARLIGHT_TILE_SIZE == other_y / NEARLIGHT_TILE_SIZE;
    const uint farther = std::max(apart(x, other_x), apart(y, other_y));
    return same_square && farther == 1;
}

}  // namespace

CameraLight expected_camera_light(const FilmSamples& samples, const FilmLayout& layout, uint half_end, uint x,
                                  uint y) {
    std::array<std::array<double, 3>, 2> halves{};
    for (uint s = 0; s < layout.samples * layout.branches; ++s) {
        const uint sample = s / layout.branches;
        const auto [packet, lane] = place_of(layout, x, y, sample, s % layout.branches);
        const CameraVertex& vertex = samples.vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
        for (std::size_t c = 0; c < 3; ++c) {
            halves[sample < half_end ? 0 : 1][c] +=
                double{vertex.filter_weight} * channels(vertex.camera_light)[c];
        }
    }
    const auto vec3 = [](const std::array<double, 3>& v) {
        return Vec3{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    return {vec3(halves[0]), vec3(halves[1])};
}

uint expected_rounds(std::span<const CameraLight> lights, std::span<const float> sums, uint width,
                     uint sample_count, uint x, uint y) {
    std::vector<double> variances;
    std::vector<double> squares;
    for (uint other = 0; other < lights.size(); ++other) {
        if (are_neighbours(x, y, other % width, other / width)) {
            variances.push_back(variance_of_mean(lights[other], sample_count));
            squares.push_back(
                squared_light(sums.subspan(std::size_t{other} * NEARLIGHT_FILM_CHANNELS), sample_count));
        }
    }
    const auto count = static_cast<double>(squares.size());
    const double mean_square = std::reduce(squares.begin(), squares.end()) / count;
    double relative = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
        relative += variances[i] > 0 ? variances[i] / (squares[i] + 0.01 * mean_square) / count : 0.0;
    }
    const double wanted = std::sqrt(relative * sample_count / NEARLIGHT_ENOUGH_VARIANCE);
    return wanted > 1
               ? static_cast<uint>(std::min(std::round(std::log2(wanted)), double{NEARLIGHT_MAX_ROUNDS}))
               : 0;
}

}  // namespace nearlight::core
