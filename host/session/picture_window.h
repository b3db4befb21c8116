// SPDX-License-Identifier: Apache-2.0
// A part of a picture that is rendered alone.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/session/session.h"

namespace nearlight::core {

/// The part that is wanted of a picture; all of it if `wanted` is empty. Throws
/// Error(ErrorKind::invalid_argument) if it has no pixels or reaches beyond the picture.
PixelWindow window_of(uint width, uint height, const std::optional<PixelWindow>& wanted);
inline PixelWindow window_of(const View& view, const GatherSettings& settings) {
    return window_of(view.camera.width, view.camera.height, settings.window);
}

/// Cuts rows to a part of the picture.
class WindowCut {
  public:
    /// The rows that come are those of `cover`, with NEARLIGHT_LAYER_CHANNELS floats a pixel; `window` lies
    /// within it.
    WindowCut(const PixelWindow& cover, const PixelWindow& window) : cover_(cover), window_(window) {}

    /// Takes further rows, from top to bottom, and returns what belongs to the window. The result is valid
    /// until the next call, and as long as `rows`.
    std::span<const float> cut(std::span<const float> rows);

  private:
    PixelWindow cover_;
    PixelWindow window_;
    uint next_row_ = 0;  ///< of `cover`
    std::vector<float> kept_;
};

}  // namespace nearlight::core
