// SPDX-License-Identifier: Apache-2.0
#include "host/cli/override_options.h"

#include <algorithm>
#include <cmath>

#include "host/cli/log.h"
#include "host/scene/number_text.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr const char* kPoint = "X,Y,Z, finite numbers separated by commas";

/// N numbers separated by commas. `wanted` says in errors what `option` must be.
template <std::size_t N>
std::array<double, N> parse_numbers(const char* option, const char* wanted, const std::string& text) {
    const std::optional<std::vector<double>> given = numbers_in(text);
    const auto is_finite = [](double number) { return std::isfinite(number); };
    if (!given || given->size() != N || !std::ranges::all_of(*given, is_finite)) {
        throw Error(ErrorKind::invalid_argument,
                    std::string(option) + " must be " + wanted + ", not '" + text + "'");
    }
    std::array<double, N> numbers{};
    std::ranges::copy(*given, numbers.begin());
    return numbers;
}

void add_camera_options(CLI::App& command, SceneOptions& options) {
    SceneOverrides& overrides = options.overrides;
    command
        .add_option("--camera", options.camera,
                    "Camera of the scene: its name, or its number counted from 1 (default: the first)")
        ->type_name("NAME|N");
    command
        .add_option_function<std::string>(
            "--origin",
            [&](const std::string& text) { overrides.origin = parse_numbers<3>("--origin", kPoint, text); },
            "Where the camera stands; it looks at --target")
        ->type_name("X,Y,Z");
    command
        .add_option_function<std::string>(
            "--target",
            [&](const std::string& text) { overrides.target = parse_numbers<3>("--target", kPoint, text); },
            "What the camera looks at (default with --origin: the middle of the scene)")
        ->type_name("X,Y,Z");
    command
        .add_option_function<std::string>(
            "--up", [&](const std::string& text) { overrides.up = parse_numbers<3>("--up", kPoint, text); },
            "The direction that is upwards in the picture")
        ->type_name("X,Y,Z");
    command
        .add_option_function<std::string>(
            "--fov",
            [&](const std::string& text) {
                overrides.fov_degrees = parse_numbers<1>("--fov", "a number of degrees", text)[0];
            },
            "Horizontal field of view, degrees")
        ->type_name("DEG");
}

}  // namespace

void add_override_options(CLI::App& command, SceneOptions& options) {
    SceneOverrides& overrides = options.overrides;
    add_camera_options(command, options);
    command
        .add_option(
            "--environment", overrides.environment,
            "Environment in place of the scene's: an image file (latitude-longitude), sky (a clear sky), "
            "or an even colour as R,G,B, one number for grey, or #rrggbb")
        ->type_name("FILE|sky|COLOR");
    command
        .add_option("--environment-rotation", overrides.environment_rotation,
                    "Turns the environment about the vertical axis, +Y")
        ->type_name("DEG");
    command
        .add_option("--environment-scale", overrides.environment_scale,
                    "Multiplies the light of the environment")
        ->type_name("F");
    command
        .add_option_function<std::string>(
            "--sun",
            [&](const std::string& text) {
                const auto [azimuth, elevation] =
                    parse_numbers<2>("--sun", "AZIMUTH,ELEVATION, two numbers of degrees", text);
                overrides.sun = SunPosition{azimuth, elevation};
            },
            "Adds the sun there: degrees from +Z towards +X, and above the horizon; --environment sky "
            "follows it")
        ->type_name("AZIMUTH,ELEVATION");
    command.add_option("--light-scale", overrides.light_scale, "Multiplies all light of the scene")
        ->type_name("F");
}

std::vector<std::string> override_arguments(const SceneOptions& options) {
    const SceneOverrides& overrides = options.overrides;
    const SceneOverrides otherwise;
    std::vector<std::string> arguments;
    const auto add = [&](const char* option, bool is_given, const std::string& value) {
        if (is_given) {
            arguments.push_back(std::string(option) + "=" + value);
        }
    };
    const auto add_number = [&](const char* option, double value, double usual) {
        add(option, value != usual, fmt::format("{}", value));
    };
    add("--camera", !options.camera.empty(), options.camera);
    add("--environment", !overrides.environment.empty(), overrides.environment);
    add_number("--environment-rotation", overrides.environment_rotation, otherwise.environment_rotation);
    add_number("--environment-scale", overrides.environment_scale, otherwise.environment_scale);
    if (overrides.sun) {
        add("--sun", true, fmt::format("{},{}", overrides.sun->azimuth, overrides.sun->elevation));
    }
    add_number("--light-scale", overrides.light_scale, otherwise.light_scale);
    return arguments;
}

}  // namespace nearlight::core
