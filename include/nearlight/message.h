// SPDX-License-Identifier: Apache-2.0
// Where the library's warnings go.
#pragma once

#include <functional>
#include <string_view>

#include "nearlight/export.h"

namespace nearlight {

/// How much a message matters.
enum class MessageLevel {
    debug,    ///< what was decided and how long it took, for those who look for the reason of something
    warning,  ///< the result is valid, but may not be what the caller had in mind
    error,    ///< more about a failure than fits in the one line of its Error, such as a compiler's log
};

/// Takes a message: one line of UTF-8 text without a line break at its end; logs of compilers have several
/// lines. The text is valid during the call only.
using MessageSink = std::function<void(MessageLevel level, std::string_view text)>;

/// From now on all messages of this process's nearlight go to `sink`; an empty one drops them, as it is
/// before the first call: the library itself prints nothing. May be called from any thread. The sink is
/// called from any thread too, but never by two at once; it must not call set_message_sink(), and must not
/// throw.
NEARLIGHT_API void set_message_sink(MessageSink sink);

}  // namespace nearlight
