// SPDX-License-Identifier: Apache-2.0
// The bitmaps of the desk.
#pragma once

#include "scenes/generator/files.h"

namespace nearlight::core::scenes {

/// The picture on the screen: windows with text and a chart.
Bitmap make_screen_picture();
/// A page with lines of illegible words.
Bitmap make_printed_page(std::uint64_t seed, bool with_picture);
/// A painting of hills under an evening sky.
Bitmap make_painting();

}  // namespace nearlight::core::scenes
