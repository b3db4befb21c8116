// SPDX-License-Identifier: Apache-2.0
// VPLs as dots over the picture.
#pragma once

#include <vector>

#include "viewer/frame.h"

namespace nearlight::viewer {

/// A VPL as it is drawn.
struct VplDot {
    float x = 0.0f;           ///< part of the picture's width, from the left, 0 to 1
    float y = 0.0f;           ///< part of the picture's height, from the top
    bool is_close = false;    ///< it lies in the close range
    bool is_hidden = false;   ///< a surface is before it
    float brightness = 0.0f;  ///< its power as a part of the strongest, by a root, so that weak ones show
};

/// The VPLs of a frame that lie inside of its picture.
std::vector<VplDot> vpl_dots(const Frame& frame);

}  // namespace nearlight::viewer
