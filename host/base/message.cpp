// SPDX-License-Identifier: Apache-2.0
#include "host/base/message.h"

#include "host/base/log.h"

namespace nearlight::core {

void say_error(const std::string& text) {
    spdlog::error("{}", text);
}

void say_warning(const std::string& text) {
    spdlog::warn("{}", text);
}

void say_debug(const std::string& text) {
    spdlog::debug("{}", text);
}

}  // namespace nearlight::core
