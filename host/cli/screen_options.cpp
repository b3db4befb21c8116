// SPDX-License-Identifier: Apache-2.0
#include "host/cli/screen_options.h"

#include "host/cli/log.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// The stops that --exposure gives; empty for "auto".
std::optional<float> exposure_of(const std::string& text) {
    return number_or_auto("--exposure", text, -100.0f, 100.0f);
}

}  // namespace

void add_screen_options(CLI::App& command, ScreenOptions& options, const std::string& what) {
    command
        .add_option("--exposure", options.exposure,
                    "Exposure of " + what +
                        ", in stops, or auto, which looks at the light on the surfaces seen "
                        "(default: 0 for Mitsuba's scenes, otherwise auto)")
        ->type_name("EV|auto");
    add_choice<ToneCurve>(
        command, "--tonemap", options.curve, {kToneCurves.begin(), kToneCurves.end()},
        "Tone curve of " + what +
            ": neutral (keeps colours), agx (a photograph's), filmic (strong contrast) "
            "or linear (clips); EXR stays linear (default: linear for Mitsuba's scenes, otherwise neutral)");
}

void check_screen_options(const ScreenOptions& options) {
    if (!options.exposure.empty()) {
        exposure_of(options.exposure);
    }
}

ScreenLook chosen_look(const ScreenOptions& options, ScreenLook look) {
    if (!options.exposure.empty()) {
        look.exposure = exposure_of(options.exposure);
    }
    look.curve = options.curve.value_or(look.curve);
    return look;
}

ScreenLook screen_look(const ScreenOptions& options, const Scene& scene) {
    return chosen_look(options,
                       scene.has_open_exposure ? ScreenLook{ToneCurve::neutral, std::nullopt} : ScreenLook());
}

void tell_automatic_exposure(const ScreenLook& look, float exposure, bool quiet) {
    spdlog::log(quiet ? spdlog::level::debug : spdlog::level::info,
                "exposure {:+.2f} stops (automatic), tone curve {}", exposure, to_string(look.curve));
}

ImageWriterOptions screen_writer_options(const ScreenLook& look, float exposure, Metadata metadata) {
    metadata["nearlight:tonemap"] = to_string(look.curve);
    metadata["nearlight:exposure"] = fmt::format("{:+.3f}", exposure);
    return {std::move(metadata), exposure, look.curve};
}

}  // namespace nearlight::core
