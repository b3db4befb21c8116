// SPDX-License-Identifier: Apache-2.0
#include "host/image/image.h"

#include <algorithm>
#include <utility>

namespace nearlight::core {

int Image::find_channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

Image make_image(int width, int height, std::vector<std::string> channels) {
    Image image{width, height, std::move(channels), {}};
    image.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        image.channel_count());
    return image;
}

}  // namespace nearlight::core
