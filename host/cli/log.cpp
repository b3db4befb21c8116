// SPDX-License-Identifier: Apache-2.0
#include "host/cli/log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <memory>
#include <set>
#include <string>

#include "host/base/printable.h"

namespace nearlight::core {
namespace {

spdlog::level::level_enum log_level(MessageLevel level) {
    return level == MessageLevel::error     ? spdlog::level::err
           : level == MessageLevel::warning ? spdlog::level::warn
                                            : spdlog::level::debug;
}

/// What a pattern has for the text of a message: only what may go to a terminal.
class PrintableText : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
        const std::string text = printable({message.payload.data(), message.payload.size()});
        out.append(text.data(), text.data() + text.size());
    }
    [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<PrintableText>();
    }
};

}  // namespace

void show_message(MessageLevel level, std::string_view text, const std::string& speaker) {
    // Only a compiler's log has several lines.
    spdlog::log(log_level(level), "{}{}", speaker.empty() ? "" : speaker + ": ",
                level == MessageLevel::warning ? printable_line(text) : std::string(text));
}

void set_up_log(Verbosity verbosity) {
    auto logger = std::make_shared<spdlog::logger>("nearlight",
                                                   std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    // Lines have a time only in verbose mode.
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<PrintableText>('*').set_pattern(verbosity == Verbosity::verbose ? "[%T.%e] %^%l%$: %*"
                                                                                        : "%^%l%$: %*");
    logger->set_formatter(std::move(formatter));
    logger->set_level(verbosity == Verbosity::quiet     ? spdlog::level::err
                      : verbosity == Verbosity::verbose ? spdlog::level::debug
                                                        : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
    core::set_message_sink([](MessageLevel level, std::string_view text) { show_message(level, text); });
}

void show_messages_once() {
    set_message_sink([shown = std::set<std::string>()](MessageLevel level, std::string_view text) mutable {
        if (level == MessageLevel::debug || shown.emplace(text).second) {
            show_message(level, text);
        }
    });
}

}  // namespace nearlight::core
