// SPDX-License-Identifier: Apache-2.0
// How far two pictures are apart.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/image/image.h"

namespace nearlight::core {

struct ImageDifference {
    double rmse = 0;             ///< root mean square over pixels and R, G, B (the paper's measure)
    double relative_mse = 0;     ///< mean of (a − b)² / (b² + 0.01), b the reference
    double mean_ratio = 0;       ///< mean luminance of a ÷ mean luminance of b: light lost or gained
    double flip = 0;             ///< mean FLIP of the tone-mapped pictures [Andersson et al. 2020]
    std::size_t non_finite = 0;  ///< pixels with NaN or infinity in either; left out of the figures
};

/// Names of the layers with channels R, G and B, in the order of the picture; "" is the picture itself.
std::vector<std::string> color_layers(const Image& image);
bool has_color_layer(const Image& image, const std::string& layer);

/// Compares the three channels `layer`.R, .G, .B (or R, G, B for an empty layer) of a with those of the
/// reference b. Throws Error(ErrorKind::file) where sizes differ or a channel is missing.
ImageDifference compare_images(const Image& a, const Image& b, const std::string& layer = "");
/// Per-pixel FLIP error of the same channels, as channels R, G, B in a magma-like colour map.
Image flip_map(const Image& a, const Image& b, const std::string& layer = "");

}  // namespace nearlight::core
