// SPDX-License-Identifier: Apache-2.0
#include "host/image/image.h"

#include <algorithm>
#include <utility>

namespace nearlight::core {

int Image::find_channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

std::string_view layer_of(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    if (dot != std::string_view::npos) {
        return channel.substr(0, dot);
    }
    return channel == "R" || channel == "G" || channel == "B" ? "beauty" : channel;
}

std::vector<std::string> layer_names(std::span<const std::string> channels) {
    std::vector<std::string> names;
    for (const std::string& channel : channels) {
        if (std::ranges::find(names, layer_of(channel)) == names.end()) {
            names.emplace_back(layer_of(channel));
        }
    }
    return names;
}

Image part_of(const Image& image, int x, int y, int width, int height) {
    Image part = make_image(width, height, image.channels);
    part.holds_floats = image.holds_floats;
    const std::size_t row = static_cast<std::size_t>(width) * image.channel_count();
    for (int i = 0; i < height; ++i) {
        const std::size_t from = static_cast<std::size_t>(y + i) * static_cast<std::size_t>(image.width) +
                                 static_cast<std::size_t>(x);
        std::copy_n(image.values.data() + from * image.channel_count(), row,
                    part.values.data() + static_cast<std::size_t>(i) * row);
    }
    return part;
}

Image make_image(int width, int height, std::vector<std::string> channels) {
    Image image{width, height, std::move(channels), {}};
    image.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        image.channel_count());
    return image;
}

}  // namespace nearlight::core
