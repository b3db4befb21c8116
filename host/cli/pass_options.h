// SPDX-License-Identifier: Apache-2.0
// The options of `nearlight render` that say how many passes there are, and what it says about them.
#pragma once

#include <optional>
#include <vector>

#include "host/cli/command.h"
#include "host/cli/picture_files.h"
#include "host/session/render.h"

namespace nearlight::core {

struct PassOptions {
    std::optional<uint> passes;
    std::optional<double> seconds;  ///< time limit of the whole command
    std::optional<double> error;
    std::vector<uint> pass_samples;
};

/// Adds --passes, --time, --error and --pass-spp.
void add_pass_options(CLI::App& command, PassOptions& options);

/// Throws Error(ErrorKind::invalid_argument) if the layer `variance` is asked for of a picture that cannot
/// have more than a single sample per pixel, which says nothing about its error.
void check_variance_is_known(const PictureOptions& picture, const RenderSettings& settings);
/// Warns if the layer `variance` is asked for and passes of these samples per pixel do not tell it.
void warn_of_unknown_variance(const PictureOptions& picture, std::span<const uint> samples);
/// Warns if some passes of --pass-spp have so few samples per pixel that they have no splats, and others
/// have.
void warn_of_unsplatted_passes(const RenderSettings& settings, const PixelFilter& filter);

/// Logs after a pass how long the way to the error is.
void tell_forecast(const PassForecast& forecast, double target);

/// Logs what became of --error and --time. `seconds` is what the command took.
void tell_limits(const PassOptions& options, const RenderReport& report, uint min_samples, double seconds);

}  // namespace nearlight::core
