// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/calls.h"

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "nearlight/message.h"
#include "python/bindings/convert.h"

namespace nearlight::python {
namespace {

/// Levels of Python's module logging.
constexpr int level_of(MessageLevel level) {
    return level == MessageLevel::debug ? 10 : level == MessageLevel::warning ? 30 : 40;
}

struct WaitingMessage {
    MessageLevel level;
    std::string text;
};

class MessageList {
  public:
    void add(MessageLevel level, std::string_view text) {
        const std::scoped_lock lock(guard_);
        messages_.push_back({level, std::string(text)});
    }
    std::vector<WaitingMessage> take() {
        const std::scoped_lock lock(guard_);
        return std::exchange(messages_, {});
    }

  private:
    std::mutex guard_;
    std::vector<WaitingMessage> messages_;
};

/// There is one list because the library has one sink for the whole process. It is never destroyed, because
/// threads of drivers may outlive everything else.
MessageList& message_list() {
    static auto& list = *new MessageList;
    return list;
}

}  // namespace

void collect_messages() {
    set_message_sink(
        [&list = message_list()](MessageLevel level, std::string_view text) { list.add(level, text); });
}

void deliver_messages() {
    for (const auto& [level, text] : message_list().take()) {
        const py::object log = py::module_::import("logging").attr("getLogger")("nearlight").attr("log");
        log(level_of(level), "%s", decoded(text));
    }
}

ProgressCall::ProgressCall(py::object function) : function_(std::move(function)) {
    if (!function_.is_none() && PyCallable_Check(function_.ptr()) == 0) {
        fail_type("progress", "a function", function_);
    }
}

bool ProgressCall::operator()(double fraction) {
    const py::gil_scoped_acquire acquired;
    try {
        deliver_messages();
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
        return function_.is_none() || !function_(fraction).is(py::bool_(false));
    } catch (...) {
        raised_ = std::current_exception();
        return false;
    }
}

void ProgressCall::rethrow() const {
    if (raised_) {
        std::rethrow_exception(raised_);
    }
}

}  // namespace nearlight::python
