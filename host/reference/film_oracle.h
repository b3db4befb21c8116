// SPDX-License-Identifier: Apache-2.0
// Samples of all kinds for a film, and the layers that must become of them, in double precision.
#pragma once

#include <cstddef>
#include <vector>

#include "host/base/math.h"
#include "kernels/shared/film_layers.h"

namespace nearlight::core {

/// A picture whose edges cut tiles.
struct FilmLayout {
    uint width = 13;
    uint height = 11;
    uint samples = 3;   ///< a pixel
    uint branches = 2;  ///< a sample

    [[nodiscard]] std::size_t tile_columns() const {
        return (width + NEARLIGHT_TILE_SIZE - 1) / NEARLIGHT_TILE_SIZE;
    }
    [[nodiscard]] std::size_t tile_rows() const {
        return (height + NEARLIGHT_TILE_SIZE - 1) / NEARLIGHT_TILE_SIZE;
    }
};

/// What the camera pass and both kinds of light leave of the whole picture.
struct FilmSamples {
    std::vector<ReceiverPacket> receivers;
    std::vector<CameraVertex> vertices;
    std::vector<IrradiancePacket> direct;
    std::vector<IrradiancePacket> indirect;
};

/// Random numbers in every field; some camera rays meet nothing.
FilmSamples random_film_samples(const FilmLayout& layout);

/// What the layers of a pixel must be, in the order of layer_channels().
std::vector<double> expected_layers(const FilmSamples& samples, const FilmLayout& layout, uint x, uint y);

}  // namespace nearlight::core
