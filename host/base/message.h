// SPDX-License-Identifier: Apache-2.0
// Messages for people. They go to the sink that the program has set, and are dropped until it has set one.
#pragma once

#include <string>

#include "nearlight/message.h"

namespace nearlight::core {

/// The implementation of nearlight::set_message_sink().
void set_message_sink(MessageSink sink);

void say_error(const std::string& text);
void say_warning(const std::string& text);
void say_debug(const std::string& text);
/// Warns that a device is left out because it failed.
void say_lost_device(const std::string& device, const std::string& reason);

}  // namespace nearlight::core
