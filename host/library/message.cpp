// SPDX-License-Identifier: Apache-2.0
#include "nearlight/message.h"

#include <utility>

#include "host/base/message.h"

namespace nearlight {

void set_message_sink(MessageSink sink) {
    core::set_message_sink(std::move(sink));
}

}  // namespace nearlight
