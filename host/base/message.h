// SPDX-License-Identifier: Apache-2.0
// Messages for people from the rooms that the minimal build has too. There they are plain lines on standard
// error; in the full program they go through its logger (host/base/log.h).
#pragma once

#include <string>

namespace nearlight::core {

void say_error(const std::string& text);
void say_warning(const std::string& text);
/// Shown with --verbose only; never in the minimal build.
void say_debug(const std::string& text);

}  // namespace nearlight::core
