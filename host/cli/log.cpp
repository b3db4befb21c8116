// SPDX-License-Identifier: Apache-2.0
#include "host/cli/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

#include "host/base/message.h"

namespace nearlight::core {
namespace {

spdlog::level::level_enum log_level(MessageLevel level) {
    return level == MessageLevel::error     ? spdlog::level::err
           : level == MessageLevel::warning ? spdlog::level::warn
                                            : spdlog::level::debug;
}

}  // namespace

void set_up_log(Verbosity verbosity) {
    auto logger = std::make_shared<spdlog::logger>("nearlight",
                                                   std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    // Lines have a time only in verbose mode.
    logger->set_pattern(verbosity == Verbosity::verbose ? "[%T.%e] %^%l%$: %v" : "%^%l%$: %v");
    logger->set_level(verbosity == Verbosity::quiet     ? spdlog::level::err
                      : verbosity == Verbosity::verbose ? spdlog::level::debug
                                                        : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
    set_message_sink(
        [](MessageLevel level, std::string_view text) { spdlog::log(log_level(level), "{}", text); });
}

}  // namespace nearlight::core
