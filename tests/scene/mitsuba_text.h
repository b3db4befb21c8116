// SPDX-License-Identifier: Apache-2.0
// Elements of Mitsuba scene files as text.
#pragma once

#include <string>

namespace nearlight::core::test {

inline std::string shape(const std::string& type, const std::string& body = "") {
    return "<shape type='" + type + "'>" + body + "</shape>";
}
inline std::string to_world(const std::string& body) {
    return "<transform name='to_world'>" + body + "</transform>";
}

}  // namespace nearlight::core::test
