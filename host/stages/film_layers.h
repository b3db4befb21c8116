// SPDX-License-Identifier: Apache-2.0
// The table of kernels/shared/film_layers.h as the host reads it: what layers a picture has, and where.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/shared/film_layers.h"

namespace nearlight::core {

/// How several passes become one picture.
enum class PassRule { mean, first };

struct FilmLayer {
    std::string_view name;          ///< "beauty", "direct", …
    std::string_view suffixes;      ///< one letter for each channel
    std::size_t first_channel = 0;  ///< of the picture's NEARLIGHT_LAYER_CHANNELS
    std::size_t channel_count = 0;
    PassRule passes = PassRule::mean;

    [[nodiscard]] constexpr bool is_beauty() const { return first_channel == NEARLIGHT_LAYER_BEAUTY; }
};

#define NEARLIGHT_LAYER_ROW(constant, name, channels, samples, passes) \
    FilmLayer{name, #channels, NEARLIGHT_LAYER_##constant, NEARLIGHT_CHANNELS_##channels, PassRule::passes},
/// In the order of the picture's channels.
inline constexpr std::array kFilmLayers{NEARLIGHT_FILM_LAYERS(NEARLIGHT_LAYER_ROW)};
#undef NEARLIGHT_LAYER_ROW

/// Names of a layer's channels as files have them: R, G and B of the beauty, "direct.R" of others.
std::vector<std::string> channel_names(const FilmLayer& layer);

/// Names of a finished picture's channels: R, G, B, direct.R, …, closerange.Y.
std::vector<std::string> layer_channels();

/// For each channel of a picture, how several passes become one.
std::array<PassRule, NEARLIGHT_LAYER_CHANNELS> pass_rules();

}  // namespace nearlight::core
