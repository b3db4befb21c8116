// SPDX-License-Identifier: Apache-2.0
// Files that the window writes beside pictures.
#pragma once

#include <filesystem>
#include <string>

#include "viewer/display.h"

namespace nearlight::viewer {

/// Writes the content of a window as a PNG file. Throws as write_image() does.
void write_screenshot(const std::filesystem::path& file, const ScreenPixels& pixels);

/// Writes a text. Throws Error(ErrorKind::file) if that fails.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace nearlight::viewer
