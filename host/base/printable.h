// SPDX-License-Identifier: Apache-2.0
// Text from files and from the command line, on its way to a terminal or to other files.
#pragma once

#include <string>
#include <string_view>

namespace nearlight::core {

/// The text without what a terminal would obey: control characters other than line breaks and tabs become
/// question marks, and so does what is not UTF-8.
std::string printable(std::string_view text);

/// The printable() text as one line, which is cut after 5000 bytes, because nobody reads more.
std::string printable_line(std::string_view text);

/// The text if it is UTF-8, and else the characters that its bytes are in Latin-1.
std::string utf8_or_latin1(std::string text);

}  // namespace nearlight::core
