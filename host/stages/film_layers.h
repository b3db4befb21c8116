// SPDX-License-Identifier: Apache-2.0
// The table of kernels/shared/film_layers.h as the host reads it: the layers of a picture and the places of
// their channels.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/shared/film_layers.h"

namespace nearlight::core {

/// How several passes become one picture: as their mean, by taking the first, or as the variance of the mean.
enum class PassRule { mean, first, variance };
/// Which EXR files get a layer: all for which no list of layers is given, or only those whose list names it.
enum class FileRule { always, asked };
/// What numbers EXR files have: 16-bit or 32-bit floats.
enum class Storage { half, full };

struct FilmLayer {
    std::string_view name;          ///< "beauty", "direct", …
    std::string_view suffixes;      ///< one letter for each channel
    std::size_t first_channel = 0;  ///< index among the picture's NEARLIGHT_LAYER_CHANNELS
    std::size_t channel_count = 0;
    PassRule passes = PassRule::mean;
    FileRule files = FileRule::always;
    Storage storage = Storage::half;

    [[nodiscard]] constexpr bool is_beauty() const { return first_channel == NEARLIGHT_LAYER_BEAUTY; }
};

#define NEARLIGHT_LAYER_ROW(constant, name, channels, samples, passes, files, storage) \
    FilmLayer{name,                                                                    \
              #channels,                                                               \
              NEARLIGHT_LAYER_##constant,                                              \
              NEARLIGHT_CHANNELS_##channels,                                           \
              PassRule::passes,                                                        \
              FileRule::files,                                                         \
              Storage::storage},
/// All layers, in the order of the picture's channels.
inline constexpr std::array kFilmLayers{NEARLIGHT_FILM_LAYERS(NEARLIGHT_LAYER_ROW)};
#undef NEARLIGHT_LAYER_ROW

/// The rule by which several passes become one picture, for each channel.
constexpr std::array<PassRule, NEARLIGHT_LAYER_CHANNELS> pass_rules() {
    std::array<PassRule, NEARLIGHT_LAYER_CHANNELS> rules{};
    for (const FilmLayer& layer : kFilmLayers) {
        for (std::size_t i = 0; i < layer.channel_count; ++i) {
            rules[layer.first_channel + i] = layer.passes;
        }
    }
    return rules;
}

/// How many channels have this rule.
constexpr std::size_t channels_with(PassRule rule) {
    std::size_t count = 0;
    for (const FilmLayer& layer : kFilmLayers) {
        count += layer.passes == rule ? layer.channel_count : 0;
    }
    return count;
}

/// The names of a layer's channels in files: R, G and B for the beauty, A for the coverage, names like
/// "direct.R" for other layers.
std::vector<std::string> channel_names(const FilmLayer& layer);

/// The names of a finished picture's channels: R, G, B, direct.R, …, A.
std::vector<std::string> layer_channels();

}  // namespace nearlight::core
