// SPDX-License-Identifier: Apache-2.0
// How pictures for screens (PNG) look: exposure and tone curve.
#pragma once

#include <optional>
#include <string>

#include "host/cli/command.h"
#include "host/image/image_io.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct ScreenOptions {
    std::string exposure;  ///< stops or "auto"; empty: as the scene asks
    std::optional<ToneCurve> curve;
};

/// What the options come to for a scene.
struct ScreenLook {
    ToneCurve curve = ToneCurve::linear;
    std::optional<float> exposure = 0.0f;  ///< stops; empty: automatic, by the finished picture
};

/// Adds --exposure and --tonemap, which decide how `what` looks.
void add_screen_options(CLI::App& command, ScreenOptions& options, const std::string& what = "PNG pictures");

/// Throws Error(ErrorKind::invalid_argument) if the exposure is neither a number nor "auto".
void check_screen_options(const ScreenOptions& options);

/// Scenes that say how bright their light is are shown as they are, others with automatic exposure and a
/// neutral curve, unless the options say otherwise.
ScreenLook screen_look(const ScreenOptions& options, const Scene& scene);

/// The look of a picture whose scene asks for `look`.
ScreenLook chosen_look(const ScreenOptions& options, ScreenLook look);

/// Says which exposure was chosen for a picture with that look. If it is `quiet`, only --verbose shows it.
void tell_automatic_exposure(const ScreenLook& look, float exposure, bool quiet);

/// Writer options for a PNG file with that look and the attributes that name it.
ImageWriterOptions screen_writer_options(const ScreenLook& look, float exposure, Metadata metadata);

}  // namespace nearlight::core
