// SPDX-License-Identifier: Apache-2.0
#include "host/session/picture_window.h"

#include <cstdint>
#include <string>

#include "host/stages/film_layers.h"
#include "nearlight/error.h"

namespace nearlight::core {

PixelWindow window_of(uint width, uint height, const std::optional<PixelWindow>& wanted) {
    const PixelWindow window = wanted.value_or(PixelWindow{0, 0, width, height});
    if (window.width < 1 || window.height < 1 || std::uint64_t{window.x} + window.width > width ||
        std::uint64_t{window.y} + window.height > height) {
        throw Error(ErrorKind::invalid_argument,
                    "the part of " + std::to_string(window.width) + "x" + std::to_string(window.height) +
                        " pixels at " + std::to_string(window.x) + "," + std::to_string(window.y) +
                        " is not within the picture of " + std::to_string(width) + "x" +
                        std::to_string(height),
                    "window");
    }
    return window;
}

std::span<const float> WindowCut::cut(std::span<const float> rows) {
    if (cover_ == window_) {
        return rows;
    }
    const std::size_t row_size = std::size_t{cover_.width} * NEARLIGHT_LAYER_CHANNELS;
    const std::size_t first = std::size_t{window_.x - cover_.x} * NEARLIGHT_LAYER_CHANNELS;
    kept_.clear();
    for (; !rows.empty(); rows = rows.subspan(row_size), ++next_row_) {
        const uint y = cover_.y + next_row_;
        if (y >= window_.y && y < window_.y + window_.height) {
            const auto row = rows.subspan(first, std::size_t{window_.width} * NEARLIGHT_LAYER_CHANNELS);
            kept_.insert(kept_.end(), row.begin(), row.end());
        }
    }
    return kept_;
}

}  // namespace nearlight::core
