// SPDX-License-Identifier: Apache-2.0
// Messages for people go to standard error; standard output is for results.
#pragma once

#include <spdlog/spdlog.h>

#include <string>
#include <string_view>

#include "host/base/message.h"

namespace nearlight::core {

enum class Verbosity { quiet, normal, verbose };

/// Sets up the process's logger on standard error, which also receives the messages of all rooms
/// (host/base/message.h). `quiet` shows errors only, `verbose` also debug messages. Commands write with
/// spdlog::info(), warn() and debug().
void set_up_log(Verbosity verbosity);

/// Shows a message of a room, after the name of who says it if that is another process.
void show_message(MessageLevel level, std::string_view text, const std::string& speaker = {});

/// From now on, messages of rooms with the same text are shown once: for commands that read one file many
/// times.
void show_messages_once();

}  // namespace nearlight::core
