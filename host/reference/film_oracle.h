// SPDX-License-Identifier: Apache-2.0
// The film's oracle: samples of all kinds, and the layers that the film must make of them, in double
// precision.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "host/base/math.h"
#include "kernels/shared/film_layers.h"

namespace nearlight::core {

/// A small picture whose right and lower edges cut tiles.
struct FilmLayout {
    uint width = 13;
    uint height = 11;
    uint samples = 3;   ///< samples per pixel
    uint branches = 2;  ///< branches per sample

    [[nodiscard]] std::size_t tile_columns() const {
        return (width + NEARLIGHT_TILE_SIZE - 1) / NEARLIGHT_TILE_SIZE;
    }
    [[nodiscard]] std::size_t tile_rows() const {
        return (height + NEARLIGHT_TILE_SIZE - 1) / NEARLIGHT_TILE_SIZE;
    }
};

/// What the camera pass, the gather and the receivers' paths hand to the film, for the whole picture.
struct FilmSamples {
    std::vector<ReceiverPacket> receivers;
    std::vector<CameraVertex> vertices;
    std::vector<IrradiancePacket> direct;
    std::vector<IrradiancePacket> gathered;
    std::vector<IrradiancePacket> indirect;
};

/// The packet and the lane of a branch of a sample of pixel (x, y).
std::pair<std::size_t, std::size_t> place_of(const FilmLayout& layout, uint x, uint y, uint sample,
                                             uint branch);

/// The samples `first` to `first` + `count` of each pixel, as a batch has them.
FilmSamples batch_of_samples(const FilmSamples& samples, const FilmLayout& layout, uint first, uint count);

/// The light that a branch of a sample sends to the camera, radiance.
struct BranchLight {
    double direct[3] = {};
    double indirect[3] = {};
};
BranchLight branch_light(const FilmSamples& samples, std::size_t packet, std::size_t lane);

/// Samples with random numbers in every field. Some camera rays meet nothing, and some receivers are absent.
FilmSamples random_film_samples(const FilmLayout& layout);

/// The values that the layers of a pixel must have, in the order of layer_channels().
std::vector<double> expected_layers(const FilmSamples& samples, const FilmLayout& layout, uint x, uint y);

}  // namespace nearlight::core
