// SPDX-License-Identifier: Apache-2.0
#include "host/image/image.h"

#include <algorithm>
#include <utility>

namespace nearlight::core {

int Image::find_channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

Image part_of(const Image& image, const ImagePlace& place, int width, int height) {
    Image part = make_image(width, height, image.channels);
    part.holds_floats = image.holds_floats;
    part.place = place;
    const std::size_t row = static_cast<std::size_t>(width) * image.channel_count();
    for (int y = 0; y < height; ++y) {
        const float* const from =
            &image.values[(static_cast<std::size_t>(place.y + y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(place.x)) *
                          image.channel_count()];
        std::copy_n(from, row,
                    part.values.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(y)));
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
