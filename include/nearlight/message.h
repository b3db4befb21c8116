// SPDX-License-Identifier: Apache-2.0
// The messages of the library, and the function that they go to.
#pragma once

#include <functional>
#include <string_view>

#include "nearlight/export.h"

namespace nearlight {

/// How much a message matters.
enum class MessageLevel {
    debug,    ///< what was decided and how long it took, to find the reason of something
    warning,  ///< the result is valid, but may not be what the caller had in mind
    error,    ///< more about a failure than fits in the one line of its Error, such as a compiler's log
};

/// Takes a message: one line of UTF-8 text without a line break at its end, or several lines for a compiler's
/// log. The text is valid during the call only.
using MessageSink = std::function<void(MessageLevel level, std::string_view text)>;

/// Sends all further messages of nearlight in this process to `sink`. An empty sink drops them, as happens
/// before the first call: the library itself prints nothing. May be called from any thread. The sink may be
/// called from any thread too, but never from two at once; it must not call set_message_sink(), and must not
/// throw.
NEARLIGHT_API void set_message_sink(MessageSink sink);

}  // namespace nearlight
