// SPDX-License-Identifier: Apache-2.0
// The bitmaps of the desk.
#pragma once

#include "scenes/generator/files.h"

namespace nearlight::core::scenes {

/// Windows with text and a chart.
Bitmap make_screen_picture();
/// Lines of words that nobody can read.
Bitmap make_printed_page(std::uint64_t seed, bool with_picture);
/// Hills under an evening sky.
Bitmap make_painting();

}  // namespace nearlight::core::scenes
