// SPDX-License-Identifier: Apache-2.0
// Floating-point images with named channels.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core {

/// The place of a picture that is a part of a larger one.
struct ImagePlace {
    int x = 0;  ///< of the leftmost pixel
    int y = 0;  ///< of the topmost pixel
    int whole_width = 0;
    int whole_height = 0;

    friend bool operator==(const ImagePlace&, const ImagePlace&) = default;
};

/// An image with interleaved channels, top row first. Channel names follow OpenEXR: "R", "indirect.R",
/// "depth.Z".
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<float> values;          ///< width·height·channels.size()
    bool holds_floats = false;          ///< the file that it was read from has floats, not whole numbers
    std::optional<ImagePlace> place{};  ///< if the file that it was read from says that it is a part

    [[nodiscard]] std::size_t channel_count() const { return channels.size(); }
    [[nodiscard]] std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] float& at(int x, int y, std::size_t channel) {
        return values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x)) *
                          channels.size() +
                      channel];
    }
    [[nodiscard]] float at(int x, int y, std::size_t channel) const {
        return const_cast<Image*>(this)->at(x, y, channel);
    }
    /// Index of the channel called `name`, or -1.
    [[nodiscard]] int find_channel(std::string_view name) const;
};

/// The layer that a channel belongs to: `beauty` for R, G and B, otherwise what stands before the last dot,
/// or the whole name if there is none.
std::string_view layer_of(std::string_view channel);
/// The layers of the channels, each once, in their order.
std::vector<std::string> layer_names(std::span<const std::string> channels);

/// The part of an image whose top left pixel is (x, y). It must lie inside.
Image part_of(const Image& image, int x, int y, int width, int height);

/// An image of zeros.
Image make_image(int width, int height, std::vector<std::string> channels);

}  // namespace nearlight::core
