// SPDX-License-Identifier: Apache-2.0
// Where the layers of a picture are.
#pragma once

#include <cstddef>
#include <string_view>

#include "nearlight/image.h"

namespace nearlight::viewer {

/// Channels of a picture that follow one another.
struct Channels {
    std::size_t first = 0;
    std::size_t count = 0;  ///< 0 if the picture lacks the layer
};

/// The channels of a layer, by the names that layer_of() gives.
Channels channels_of(const Image& image, std::string_view layer);

/// A copy with the layers of shown_layers() alone, which are those that `nearlight render` writes and sends
/// unless it is asked for others.
Image with_file_layers(const Image& image);

}  // namespace nearlight::viewer
