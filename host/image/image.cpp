// SPDX-License-Identifier: Apache-2.0
#include "host/image/image.h"

#include <algorithm>
#include <utility>

namespace nearlight::core {

int Image::find_channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
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
