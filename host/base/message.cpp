// SPDX-License-Identifier: Apache-2.0
#include "host/base/message.h"

#include <mutex>
#include <utility>

namespace nearlight::core {
namespace {

// A warning may come from any thread and any depth of calls, so the sink belongs to the process.
struct MessageRoute {
    std::mutex mutex;
    MessageSink sink;
};

MessageRoute& message_route() {
    static MessageRoute route;
    return route;
}

void say(MessageLevel level, const std::string& text) {
    MessageRoute& route = message_route();
    const std::lock_guard lock(route.mutex);
    if (route.sink) {
        route.sink(level, text);
    }
}

}  // namespace

void set_message_sink(MessageSink sink) {
    MessageRoute& route = message_route();
    const std::lock_guard lock(route.mutex);
    route.sink = std::move(sink);
}

void say_error(const std::string& text) {
    say(MessageLevel::error, text);
}

void say_warning(const std::string& text) {
    say(MessageLevel::warning, text);
}

void say_debug(const std::string& text) {
    say(MessageLevel::debug, text);
}

void say_lost_device(const std::string& device, const std::string& reason) {
    say_warning("device " + device + " failed, and others do its part: " + reason);
}

}  // namespace nearlight::core
