// SPDX-License-Identifier: Apache-2.0
#include "viewer/channels.h"

#include <algorithm>
#include <vector>

#include "viewer/display.h"

namespace nearlight::viewer {

Channels channels_of(const Image& image, std::string_view layer) {
    const auto belongs = [&](const std::string& channel) { return layer_of(channel) == layer; };
    const auto first = std::ranges::find_if(image.channels, belongs);
    const auto end = std::find_if_not(first, image.channels.end(), belongs);
    return {.first = static_cast<std::size_t>(first - image.channels.begin()),
            .count = static_cast<std::size_t>(end - first)};
}

Image with_file_layers(const Image& image) {
    Image result{.width = image.width, .height = image.height};
    std::vector<std::size_t> kept;
    for (std::size_t channel = 0; channel < image.channels.size(); ++channel) {
        if (std::ranges::find(shown_layers(), layer_of(image.channels[channel]), &ShownLayer::name) !=
            shown_layers().end()) {
            kept.push_back(channel);
            result.channels.push_back(image.channels[channel]);
        }
    }
    const std::size_t stride = image.channels.size();
    result.values.reserve(image.values.size() / stride * kept.size());
    for (std::size_t pixel = 0; pixel < image.values.size(); pixel += stride) {
        for (const std::size_t channel : kept) {
            result.values.push_back(image.values[pixel + channel]);
        }
    }
    return result;
}

}  // namespace nearlight::viewer
