// SPDX-License-Identifier: Apache-2.0
// For builds without spdlog.
#include <cstdio>

#include "host/base/message.h"

namespace nearlight::core {

void say_error(const std::string& text) {
    std::fprintf(stderr, "error: %s\n", text.c_str());
}

void say_warning(const std::string& text) {
    std::fprintf(stderr, "warning: %s\n", text.c_str());
}

void say_debug(const std::string&) {}

}  // namespace nearlight::core
