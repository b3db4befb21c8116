// SPDX-License-Identifier: Apache-2.0
#include "host/cli/view_command.h"

#include <dlfcn.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "host/base/files.h"
#include "host/base/limits.h"
#include "host/base/words.h"
#include "host/cli/device_options.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/method_options.h"
#include "host/cli/output.h"
#include "host/cli/override_options.h"
#include "host/cli/picture_files.h"
#include "host/cli/scene_options.h"
#include "host/cli/screen_options.h"
#include "host/cli/tev_picture.h"
#include "host/stages/film_layers.h"
#include "viewer/viewer.h"

namespace nearlight::core {
namespace {

/// The module is found by the run path of the program, as that of images is (host/image/image_codec.h).
constexpr const char* kModule = "nearlight-viewer.so";

struct ViewOptions {
    SceneOptions scene;
    DeviceChoice device;
    RenderSettings settings;
    MethodTexts method;
    ImageSize size;
    ScreenOptions screen;
    std::string layer = "beauty";
    uint until_samples = 0;
    std::string screenshot;
    std::vector<int> inspect;  ///< empty, or X and Y
    bool shows_vpls = false;
    bool measures = false;
    std::string tev;
};

viewer::RunViewer load_viewer() {
    void* const module = dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
    void* const run = module == nullptr ? nullptr : dlsym(module, viewer::kRunViewerName);
    if (run == nullptr) {
        const char* const reason = dlerror();
        throw Error(ErrorKind::failure,
                    fmt::format("this nearlight has no viewer: cannot load {} ({}); install the packages "
                                "libglfw3-dev, libimgui-dev and libgl-dev and build again",
                                kModule, reason == nullptr ? "it is empty" : reason));
    }
    return reinterpret_cast<viewer::RunViewer>(run);
}

std::optional<nearlight::Vec3> public_point(const std::optional<std::array<double, 3>>& point) {
    return point ? std::optional(nearlight::Vec3{static_cast<float>((*point)[0]),
                                                 static_cast<float>((*point)[1]),
                                                 static_cast<float>((*point)[2])})
                 : std::nullopt;
}

/// The options for the library, which the viewer loads the scene with.
nearlight::LoadOptions public_options(const SceneOptions& scene) {
    const SceneOverrides& overrides = scene.overrides;
    nearlight::LoadOptions load{.definitions = load_options(scene).parameters,
                                .strict = scene.strict,
                                .clear_glass = scene.clear_glass,
                                .camera = scene.camera,
                                .origin = public_point(overrides.origin),
                                .target = public_point(overrides.target),
                                .up = public_point(overrides.up),
                                .fov_x_degrees = overrides.fov_degrees,
                                .environment = overrides.environment,
                                .environment_rotation = overrides.environment_rotation,
                                .environment_scale = overrides.environment_scale,
                                .light_scale = overrides.light_scale};
    if (overrides.sun) {
        load.sun = nearlight::SunPosition{overrides.sun->azimuth, overrides.sun->elevation};
    }
    return load;
}

/// The arguments of a command line that load the same scene with the same light.
std::vector<std::string> scene_arguments(const SceneOptions& scene) {
    std::vector<std::string> arguments{scene.file.string()};
    const auto add = [&](const std::string& option, const std::string& value) {
        arguments.push_back(option + "=" + value);
    };
    for (const std::string& definition : scene.definitions) {
        add("--define", definition);
    }
    if (scene.clear_glass) {
        add("--glass", "clear");
    }
    std::ranges::move(override_arguments(scene), std::back_inserter(arguments));
    return arguments;
}

/// Those that place its camera.
std::vector<std::string> camera_arguments(const SceneOverrides& overrides) {
    std::vector<std::string> arguments;
    if (overrides.origin) {
        arguments.push_back(fmt::format("--origin={}", fmt::join(*overrides.origin, ",")));
    }
    if (overrides.target) {
        arguments.push_back(fmt::format("--target={}", fmt::join(*overrides.target, ",")));
    }
    if (overrides.up) {
        arguments.push_back(fmt::format("--up={}", fmt::join(*overrides.up, ",")));
    }
    if (overrides.fov_degrees) {
        arguments.push_back(fmt::format("--fov={}", *overrides.fov_degrees));
    }
    return arguments;
}

void set_look(const ScreenOptions& screen, viewer::ViewerTask& task) {
    check_screen_options(screen);
    task.curve = screen.curve;
    if (!screen.exposure.empty()) {
        task.exposure = screen_look(screen, {}).exposure;
        task.has_automatic_exposure = !task.exposure;
    }
}

/// The place among the layers that files get unless others are asked for.
std::size_t layer_index(const std::string& name) {
    std::vector<std::string_view> names;
    for (const FilmLayer& layer : kFilmLayers) {
        if (layer.files == FileRule::always) {
            names.push_back(layer.name);
        }
    }
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        throw Error(ErrorKind::invalid_argument,
                    fmt::format("unknown layer '{}'; choose one of: {}", name, joined(names, ", ")));
    }
    return static_cast<std::size_t>(found - names.begin());
}

RenderSettings settled(const ViewOptions& options) {
    RenderSettings settings = options.settings;
    settle(options.method, settings);
    viewer::check_size(options.size.width, options.size.height);
    if (options.size.width > 0) {
        settings.view.width = options.size.width;
        settings.view.height = options.size.height;
    }
    return settings;
}

viewer::ViewerTask task_of(const ViewOptions& options) {
    viewer::ViewerTask task{.scene = options.scene.file, .settings = settled(options)};
    task.load = public_options(options.scene);
    task.device = options.device.device.empty() ? "auto" : options.device.device;
    task.device_options = {.kernel_dir = options.device.options.kernel_dir,
                           .cache_dir = options.device.options.cache_dir};
    set_look(options.screen, task);
    task.scene_arguments = scene_arguments(options.scene);
    task.camera_arguments = camera_arguments(options.scene.overrides);
    task.messages = [](MessageLevel level, std::string_view text) { show_message(level, text); };
    task.tev = options.tev;
    task.until_samples = options.until_samples;
    task.screenshot = options.screenshot;
    if (!options.inspect.empty()) {
        task.inspect = viewer::Pixel{.x = options.inspect[0], .y = options.inspect[1]};
    }
    task.shows_vpls = options.shows_vpls;
    task.layer = layer_index(options.layer);
    task.measures = options.measures;
    task.is_interrupted = interrupted;
    return task;
}

void tell(const viewer::ViewerReport& report, const GlobalOptions& global) {
    if (global.json) {
        print_json({{"width", report.width},
                    {"height", report.height},
                    {"moving_frames_per_second", report.moving_frames_per_second},
                    {"moving_divisor", report.moving_divisor},
                    {"first_full_seconds", report.first_full_seconds},
                    {"slowest_full_seconds", report.slowest_full_seconds},
                    {"first_full_processor_seconds", report.first_full_processor_seconds},
                    {"pass_seconds", report.pass_seconds}});
        return;
    }
    print(fmt::format(
        "{:.1f} frames per second in motion, at 1/{} of the width\n"
        "{:.2f} s to the first picture of {}x{} pixels after a move (at most {:.2f} s; {:.2f} s of "
        "processor time)\n"
        "{:.2f} s for each further pass\n",
        report.moving_frames_per_second, report.moving_divisor, report.first_full_seconds, report.width,
        report.height, report.slowest_full_seconds, report.first_full_processor_seconds,
        report.pass_seconds));
}

ExitCode run_view(const ViewOptions& options, const GlobalOptions& global) {
    const viewer::ViewerTask task = task_of(options);
    if (const std::string reason = reason_not_to_read(task.scene); !reason.empty()) {
        throw Error(ErrorKind::file, fmt::format("cannot read scene '{}': {}", task.scene.string(), reason));
    }
    if (!options.screenshot.empty()) {
        check_writable(options.screenshot);
    }
    warn_of_cache_file(options.device);
    const viewer::RunViewer run = load_viewer();
    catch_interrupts();
    const viewer::ViewerReport report = run(task);
    if (interrupted()) {
        return ExitCode::interrupted;
    }
    if (options.measures) {
        tell(report, global);
    } else if (global.json) {
        print_json(
            {{"scene", task.scene.string()},
             {"screenshot", task.screenshot.empty() ? nlohmann::ordered_json()
                                                    : nlohmann::ordered_json(task.screenshot.string())}});
    }
    return ExitCode::done;
}

void add_window_options(CLI::App& command, ViewOptions& options) {
    CLI::Option* const layer =
        command.add_option("--layer", options.layer, "Layer that is shown at the start")
            ->type_name("NAME")
            ->capture_default_str();
    CLI::Option* const vpls =
        command.add_flag("--show-vpls", options.shows_vpls, "Draw VPLs over the picture from the start");
    CLI::Option* const until_samples =
        command
            .add_option(
                "--until-samples", options.until_samples,
                "End by itself when the picture has so many samples per pixel, for tests and screenshots "
                "(default: when the window is closed)")
            ->check(CLI::Range(1u, kMaxSamplesPerPixel))
            ->type_name("N");
    command.add_option("--inspect", options.inspect, "With --until-samples: ask what lights this pixel")
        ->needs(until_samples)
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(0, kMaxPictureSide - 1))
        ->type_name("X,Y");
    command
        .add_option("--screenshot", options.screenshot,
                    "With --until-samples: write the window to this PNG file")
        ->needs(until_samples)
        ->type_name("FILE");
    command
        .add_flag("--measure", options.measures,
                  "Open no window, but move the camera about and say how soon pictures come")
        ->excludes(layer)
        ->excludes(vpls)
        ->excludes(until_samples);
}

}  // namespace

void add_view_command(CommandLine& line) {
    auto options = std::make_shared<ViewOptions>();
    CLI::App& command =
        line.add_command("view", "Walk about in a scene, in a window",
                         [options](const GlobalOptions& global) { return run_view(*options, global); });
    add_scene_options(command, options->scene);
    add_glass_option(command, options->scene.clear_glass);
    add_scene_size_option(command, options->size);
    add_screen_options(command, options->screen, "the window and of PNG pictures");
    add_window_options(command, *options);
    add_tev_option(command, options->tev);
    add_sample_options(command, options->settings.gather, Pilot::is_left_out);
    add_sampler_options(command, options->settings, options->method);
    add_method_options(command, options->settings, options->method, Pilot::is_left_out);
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
