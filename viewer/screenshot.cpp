// SPDX-License-Identifier: Apache-2.0
#include "viewer/screenshot.h"

#include <fstream>

#include "host/image/color.h"
#include "nearlight/error.h"

namespace nearlight::viewer {

/// Undoes the sRGB curve, which write_image() applies.
void write_screenshot(const std::filesystem::path& file, const ScreenPixels& pixels) {
    Image image{.width = pixels.width, .height = pixels.height, .channels = {"R", "G", "B"}};
    for (std::size_t i = 0; i < pixels.rgba.size(); ++i) {
        if (i % 4 != 3) {
            image.values.push_back(core::srgb_to_linear(static_cast<float>(pixels.rgba[i]) / 255.0f));
        }
    }
    write_image(file, image);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file);
    stream << text << std::flush;
    if (!stream) {
        throw Error(ErrorKind::file,
                    "cannot write '" + file.string() + "'; give a file in a folder that can be written to");
    }
}

}  // namespace nearlight::viewer
