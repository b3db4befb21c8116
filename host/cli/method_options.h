// SPDX-License-Identifier: Apache-2.0
// The options that say how light is computed, for commands that make pictures.
#pragma once

#include <optional>
#include <string>

#include "host/cli/command.h"
#include "host/cli/log.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// Values of options that are settled after the whole line is read.
struct MethodTexts {
    std::optional<Policy> policy;  ///< empty: the default
    std::string cuts = "auto";
    std::string close_fraction = "auto";
    std::string range = "auto";
    std::string clamp_radius = "auto";
};

/// Whether the command has the time for a pilot, which chooses light samples and the clamp radius.
enum class Pilot { runs, is_left_out };

/// Adds --spp and --direct-samples.
void add_sample_options(CLI::App& command, GatherSettings& gather, Pilot pilot);
/// Adds --refine, for commands whose passes have several samples.
void add_refine_option(CLI::App& command, GatherSettings& gather);
/// Adds --splat, for commands that make pictures of several samples; the text stays empty where it is not
/// given.
void add_splat_option(CLI::App& command, std::string& splat);
/// Adds --sampler, --policy, --vpls, --cuts, --vpl-set and --close-fraction.
void add_sampler_options(CLI::App& command, RenderSettings& settings, MethodTexts& texts);
/// Adds --range, --clamp-radius, --compensate, --rays, --max-depth, --seed and --roulette.
void add_method_options(CLI::App& command, RenderSettings& settings, MethodTexts& texts, Pilot pilot);

/// Puts the settled values into the settings. Throws Error(ErrorKind::invalid_argument) for a value out of
/// range, and for an option that would have no effect beside others.
void settle(const MethodTexts& texts, RenderSettings& settings);

}  // namespace nearlight::core
