// SPDX-License-Identifier: Apache-2.0
// Numbers in messages.
#pragma once

#include <cstdio>
#include <string>

namespace nearlight::core {

/// The number with two significant digits.
inline std::string short_text(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", static_cast<double>(value));
    return text;
}

}  // namespace nearlight::core
