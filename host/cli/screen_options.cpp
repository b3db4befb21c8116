// SPDX-License-Identifier: Apache-2.0
#include "host/cli/screen_options.h"

#include <charconv>
#include <cmath>

#include "host/cli/log.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// The number that --exposure gives; empty for "auto".
std::optional<float> parse_exposure(const std::string& text) {
    if (text == "auto") {
        return std::nullopt;
    }
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.data() + text.size();
    float stops = 0;
    const auto [after, error] = std::from_chars(begin, end, stops);
    if (error != std::errc{} || after != end || !(std::abs(stops) <= 100.0f)) {
        throw Error(ErrorKind::invalid_argument,
                    "--exposure must be `auto` or a number of stops from -100 to 100, not '" + text + "'");
    }
    return stops;
}

}  // namespace

void add_screen_options(CLI::App& command, ScreenOptions& options) {
    command
        .add_option(
            "--exposure", options.exposure,
            "Exposure of PNG pictures, in stops, or auto, which looks at the light on the surfaces seen "
            "(default: 0 for Mitsuba's scenes, otherwise auto)")
        ->type_name("EV|auto");
    const auto choose = [&options](const std::string& name) {
        options.curve = tone_curve(name);
        if (!options.curve) {
            throw Error(ErrorKind::invalid_argument,
                        "unknown --tonemap '" + name + "'; choose one of: " + tone_curve_names());
        }
    };
    command
        .add_option_function<std::string>(
            "--tonemap", choose,
            "Tone curve of PNG pictures: neutral (keeps colours), agx (a photograph's), filmic (strong "
            "contrast) "
            "or linear (clips); EXR stays linear (default: linear for Mitsuba's scenes, otherwise neutral)")
        ->type_name("NAME");
}

void check_screen_options(const ScreenOptions& options) {
    if (!options.exposure.empty()) {
        parse_exposure(options.exposure);
    }
}

ScreenLook screen_look(const ScreenOptions& options, const Scene& scene) {
    ScreenLook look;
    if (scene.has_open_exposure) {
        look = {ToneCurve::neutral, std::nullopt};
    }
    if (!options.exposure.empty()) {
        look.exposure = parse_exposure(options.exposure);
    }
    look.curve = options.curve.value_or(look.curve);
    return look;
}

ImageWriterOptions screen_writer_options(const ScreenLook& look, float exposure, Metadata metadata) {
    metadata["nearlight:tonemap"] = to_string(look.curve);
    metadata["nearlight:exposure"] = fmt::format("{:+.3f}", exposure);
    return {std::move(metadata), exposure, look.curve};
}

}  // namespace nearlight::core
