// SPDX-License-Identifier: Apache-2.0
// Plots of gnuplot as parts of a page.
#pragma once

#include <string>

namespace nearlight::core {

/// The `svg` element of a file that gnuplot wrote, without its background, with black lines and letters in
/// the page's own colour, so that they can be seen on a dark page too, and with a description for who does
/// not see it. All its IDs begin with `name`, which must be unique in the page and an ID by itself. Empty if
/// the text has no such element.
std::string inline_svg(const std::string& file, const std::string& description, const std::string& name);

}  // namespace nearlight::core
