// SPDX-License-Identifier: Apache-2.0
#include "host/stages/film_layers.h"

#include <algorithm>

namespace nearlight::core {

static_assert(std::ranges::all_of(kFilmLayers, [](const FilmLayer& layer) {
    return layer.suffixes.size() == layer.channel_count;
}));

std::vector<std::string> channel_names(const FilmLayer& layer) {
    const bool is_plain = layer.is_beauty() || layer.name == layer.suffixes;
    const std::string prefix = is_plain ? "" : std::string(layer.name) + ".";
    std::vector<std::string> names;
    for (const char suffix : layer.suffixes) {
        names.push_back(prefix + suffix);
    }
    return names;
}

std::vector<std::string> layer_channels() {
    std::vector<std::string> all;
    for (const FilmLayer& layer : kFilmLayers) {
        for (std::string& name : channel_names(layer)) {
            all.push_back(std::move(name));
        }
    }
    return all;
}

}  // namespace nearlight::core
