// SPDX-License-Identifier: Apache-2.0
#include "host/base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

namespace nearlight::core {

void set_up_log(Verbosity verbosity) {
    auto logger = std::make_shared<spdlog::logger>("nearlight",
                                                   std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    // Plain lines: the level is named only where it says something.
    logger->set_pattern(verbosity == Verbosity::verbose ? "[%T.%e] %^%l%$: %v" : "%^%l%$: %v");
    logger->set_level(verbosity == Verbosity::quiet     ? spdlog::level::err
                      : verbosity == Verbosity::verbose ? spdlog::level::debug
                                                        : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

}  // namespace nearlight::core
