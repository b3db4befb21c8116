// SPDX-License-Identifier: Apache-2.0
#include "host/cli/compare_command.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "host/base/limits.h"
#include "host/cli/device_options.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/progress_bar.h"
#include "host/cli/scene_options.h"
#include "host/compare/comparison.h"
#include "host/compare/number_text.h"
#include "host/compare/report.h"
#include "host/image/image_io.h"

namespace nearlight::core {
namespace {

struct CompareOptions {
    std::vector<std::filesystem::path> scenes;
    SceneOptions scene;  ///< options that apply to all scenes
    DeviceChoice device;
    ImageSize size;
    std::optional<std::string> samplers;  ///< empty: all
    std::optional<std::string> vpls;
    std::optional<std::string> baseline;
    CompareSettings settings;
};

std::vector<Crop> crops_in(const std::vector<std::string>& texts) {
    std::vector<Crop> crops;
    for (const std::string& text : texts) {
        const PixelWindow window = parse_window(text);
        crops.push_back({static_cast<int>(window.x), static_cast<int>(window.y),
                         static_cast<int>(window.width), static_cast<int>(window.height)});
    }
    return crops;
}

/// Makes settings from the options, and checks them.
CompareSettings settled(const CompareOptions& options) {
    CompareSettings settings = options.settings;
    settings.program_version = NEARLIGHT_VERSION;
    if (options.size.width > 0) {
        settings.width = options.size.width;
        settings.height = options.size.height;
    }
    if (options.samplers) {
        settings.methods = parse_methods(*options.samplers);
    }
    if (options.vpls) {
        settings.vpl_counts = parse_vpl_counts(*options.vpls);
    }
    if (options.baseline) {
        settings.baseline = parse_method(*options.baseline);
    } else if (std::ranges::find(settings.methods, settings.baseline) == settings.methods.end()) {
        settings.baseline = settings.methods.front();
    }
    check_settings(settings);
    return settings;
}

void refuse_twin_scenes(const std::vector<std::filesystem::path>& files) {
    for (auto file = files.begin(); file != files.end(); ++file) {
        if (std::find(files.begin(), file, *file) != file) {
            throw Error(ErrorKind::invalid_argument,
                        "scene '" + file->string() + "' is given twice; name each scene once");
        }
    }
}

std::vector<Scene> load_scenes(const CompareOptions& options) {
    std::vector<Scene> scenes;
    for (const std::filesystem::path& file : options.scenes) {
        SceneOptions scene = options.scene;
        scene.file = file;
        scenes.push_back(load_scene(scene));
    }
    return scenes;
}

/// Finds wrong files before any work is done.
void check_files(const CompareSettings& settings) {
    for (const std::filesystem::path& file : settings.reference_files) {
        read_metadata(file);
    }
    std::error_code ignored;
    if (std::filesystem::exists(settings.output, ignored) &&
        !std::filesystem::is_directory(settings.output, ignored)) {
        throw Error(ErrorKind::file, "-o '" + settings.output.string() + "' is a file; give a folder");
    }
}

void tell(const Comparison& comparison, const CompareSettings& settings) {
    spdlog::info("measured {} pictures, reused {} from {}", comparison.measured_cells,
                 comparison.reused_cells, settings.output.string());
    spdlog::info("wrote {}", (settings.output / "report.html").string());
}

/// The table of equal VPLs for the terminal.
std::string to_table(const Comparison& comparison) {
    std::string text;
    for (const SceneComparison& scene : comparison.scenes) {
        text += fmt::format("{}\n{:<26} {:>8} {:>9} {:>9} {:>22} {:>10} {:>8} {:>8} {:>10} {:>10}\n",
                            scene.facts.name, "sampler", "VPLs", "gathered", "sparse", "RMSE", "÷ baseline",
                            "mean", "FLIP", "generate s", "gather s");
        for (const EqualVplsRow& row : scene.equal_vpls) {
            text += fmt::format(
                "{:<26} {:>8} {:>9.0f} {:>9.0f} {:>22} {:>10} {:>8.4f} {:>8.4f} {:>10.3f} {:>10.3f}\n",
                to_string(row.method), row.vpls, row.gathered_vpls, row.sparse_vpls,
                interval_text(row.rmse.value, row.rmse.half_width), fixed_text(row.rmse_ratio, 2),
                row.mean_ratio.mean, row.flip.mean, row.generate_seconds, row.gather_seconds);
        }
    }
    return text;
}

ExitCode run_compare(const CompareOptions& options, const GlobalOptions& global) {
    CompareSettings settings = settled(options);
    settings.command_line = global.command_line;
    settings.date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
    refuse_twin_scenes(options.scenes);
    const DeviceChoice choice = with_compile_workers(options.device);
    check_files(settings);
    const std::vector<Scene> scenes = load_scenes(options);
    const auto device = open_device(choice);

    catch_interrupts();
    ProgressBar bar("comparing", global);
    const CompareObserver observer{
        .begin = [&](const std::string& step) { bar.start(step); },
        .advance = [&](double fraction, std::optional<double> left) { bar.update(fraction, left); },
        .stopped = interrupted};
    const std::optional<Comparison> comparison = compare(*device, scenes, settings, observer);
    bar.clear();
    if (!comparison) {
        spdlog::warn("interrupted; the measurements so far are kept in {}; rerun the same command to resume",
                     settings.output.string());
        return ExitCode::interrupted;
    }
    const std::string json = write_report(*comparison, settings);
    if (global.json) {
        print(json + "\n");
    } else if (!global.quiet) {
        print(to_table(*comparison));
    }
    tell(*comparison, settings);
    return ExitCode::done;
}

void add_what_options(CLI::App& command, CompareOptions& options) {
    CompareSettings& settings = options.settings;
    command
        .add_option("--samplers", options.samplers,
                    "Samplers to compare, comma-separated (default: all): " + to_string(all_methods()))
        ->type_name("LIST");
    command
        .add_option(
            "--baseline", options.baseline,
            "Sampler that ratios refer to: every sampler's numbers are divided by its numbers (default: " +
                to_string(default_method()) + ")")
        ->type_name("NAME");
    command.add_option("--vpls", options.vpls, "Numbers of VPLs, comma-separated")
        ->type_name("LIST")
        ->default_str("1000,2000,5000,10000");
    command
        .add_option("--seeds", settings.seed_count,
                    "Number of seeds; more seeds make confidence intervals narrower")
        ->check(CLI::Range(1u, 10'000u))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--first-seed", settings.first_seed, "First seed; the others follow it")
        ->check(CLI::Range(0u, 1'000'000'000u))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option_function<std::vector<std::string>>(
            "--crop",
            [&settings](const std::vector<std::string>& texts) { settings.crops = crops_in(texts); },
            "Part of the picture to enlarge in the report; may be given several times (default: "
            "where errors are largest)")
        ->type_name("WxH+X+Y")
        ->allow_extra_args(false);
}

void add_light_options(CLI::App& command, CompareSettings& settings) {
    command
        .add_option("--spp", settings.samples_per_pixel,
                    "Camera samples per pixel; a single one lies at the pixel's centre")
        ->check(CLI::Range(1u, kMaxSamplesPerPixel))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--clamp-radius", settings.clamp_radius,
                    "Clamp radius of all samplers and of the reference, in m")
        ->check(number_from(0, kMaxLength))
        ->type_name("R");
    command
        .add_option(
            "--clamp-fraction", settings.clamp_fraction,
            "Clamp radius as a fraction of the range (default: the radius of --reference, or else 0.025)")
        ->check(number_from(0, 10))
        ->type_name("F");
    command
        .add_option("--range", settings.range,
                    "Distance from the camera at which the close range ends, in m (default: as in "
                    "`render`)")
        ->check(number_from(1e-6, kMaxLength))
        ->type_name("R");
    command
        .add_option("--max-depth", settings.max_depth,
                    "Maximum path depth, counted as in Mitsuba (default: the scene's, or 256)")
        ->check(CLI::Range(1u, kMaxPathDepth))
        ->type_name("N");
}

void add_reference_options(CLI::App& command, CompareSettings& settings) {
    command
        .add_option("--reference-spp", settings.reference_spp,
                    "Samples per pixel of the path-traced reference, rounded up to a multiple of 16")
        ->check(CLI::Range(8, 1 << 24))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--reference-vpls", settings.reference_vpls,
                    "Make the reference with this many VPLs: at least 200000 with instant radiosity, as in "
                    "the paper, or ten times the largest number compared with another sampler")
        ->check(CLI::Range(std::size_t{1}, kMaxReferenceVpls))
        ->type_name("N");
    command
        .add_option_function<std::string>(
            "--reference-sampler",
            [&settings](const std::string& name) { settings.reference_sampler = parse_method(name); },
            "Sampler that makes the VPLs of --reference-vpls (default: instant-radiosity)")
        ->type_name("NAME");
    command
        .add_option("--reference", settings.reference_files,
                    "Reference made by `nearlight reference`; may be given several times, once per scene")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command
        .add_option("--reference-dir", settings.reference_folder,
                    "Folder for references (default: DIR/references)")
        ->type_name("DIR");
}

}  // namespace

void add_compare_command(CommandLine& line) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App& command = line.add_command(
        "compare", "Compare VPL samplers on scenes: tables, plots and pictures in one report",
        [options](const GlobalOptions& global) { return run_compare(*options, global); });
    command
        .add_option("SCENE", options->scenes,
                    "Scenes: Mitsuba XML (.xml), glTF (.gltf, .glb), OBJ (.obj) or PLY (.ply)")
        ->required();
    add_shared_scene_options(command, options->scene);
    add_filter_option(command, options->scene.filter);
    add_bvh_option(command, options->settings.bvh_quality);
    command
        .add_option("-o,--output", options->settings.output, "Folder for the report and for all measurements")
        ->type_name("DIR")
        ->required();
    add_what_options(command, *options);
    add_size_option(command, options->size)->default_str("320x240");
    add_light_options(command, options->settings);
    add_reference_options(command, options->settings);
    add_device_options(command, options->device);
}

}  // namespace nearlight::core
