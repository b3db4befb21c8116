// SPDX-License-Identifier: Apache-2.0
// The options of cuts: how many VPLs there are beyond those that a pixel asks.
#pragma once

#include <string>

#include "host/cli/command.h"
#include "host/session/render.h"

namespace nearlight::core {

/// Adds `--cuts`, whose value goes to `cuts`, and `--vpl-set`.
void add_cuts_options(CLI::App& command, std::string& cuts, SamplingSettings& sampling);

/// Whether `--cuts` means on for these settings. Throws Error(ErrorKind::invalid_argument) if options
/// contradict one another.
bool has_cuts(const std::string& cuts, const RenderSettings& settings);

}  // namespace nearlight::core
