// SPDX-License-Identifier: Apache-2.0
#include "host/cli/reference_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/base/limits.h"
#include "host/base/stopwatch.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/progress_bar.h"
#include "host/cli/scene_options.h"
#include "host/cli/screen_options.h"
#include "host/cli/stored_reference.h"
#include "host/image/exposure_meter.h"
#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"

namespace nearlight::core {
namespace {

constexpr int kDefaultSpp = 64;

struct ReferenceOptions {
    SceneOptions scene;
    ScreenOptions screen;
    std::vector<std::filesystem::path> outputs;
    ImageSize size;
    std::optional<int> spp;
    std::optional<int> max_depth;
    float clamp_radius = 0.0f;
    bool indirect_only = false;
    bool pixel_centers = false;
    bool resume = false;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// The result of the command.
struct Outcome {
    Image image;
    int samples_before = 0;      ///< samples per pixel of the picture that was resumed
    double earlier_seconds = 0;  ///< rendering time of samples_before
    double load_seconds = 0;
    double render_seconds = 0;
    bool stopped = false;
};

PathTracerSettings make_settings(const ReferenceOptions& options, const Scene& scene) {
    PathTracerSettings settings;
    settings.width = options.size.width;
    settings.height = options.size.height;
    const int scene_spp = scene.samples_per_pixel > 0 ? scene.samples_per_pixel : kDefaultSpp;
    settings.spp = options.spp.value_or(scene_spp);
    settings.max_depth = options.max_depth.value_or(scene.max_depth);
    settings.clamp_radius = options.clamp_radius;
    settings.indirect_only = options.indirect_only;
    settings.pixel_centers = options.pixel_centers;
    settings.seed = options.seed;
    settings.threads = options.threads;
    return settings;
}

Metadata make_metadata(const PathTracerSettings& settings, const Scene& scene, double seconds,
                       bool complete) {
    Metadata metadata = reference_identity(settings, scene);
    metadata["nearlight:samplesPerPixel"] = settings.spp;
    metadata["nearlight:glass"] = glass_name(scene.clear_glass);
    metadata["nearlight:samplesPerBatch"] = settings.batch_size;
    metadata["nearlight:complete"] = complete ? 1 : 0;
    metadata["renderTimeSeconds"] = static_cast<float>(seconds);
    return metadata;
}

/// Whether each pixel has a sample.
bool is_filled(const Image& image) {
    const auto count = static_cast<std::size_t>(image.find_channel("count.X"));
    for (std::size_t pixel = 0; pixel < image.values.size(); pixel += image.channel_count()) {
        if (!(image.values[pixel + count] > 0.0f)) {
            return false;
        }
    }
    return true;
}

/// Writes the picture, and returns the files that were written: one without samples in all its pixels does
/// not take the place of an older picture. `quiet` is tell_automatic_exposure()'s.
std::vector<std::filesystem::path> write_outputs(const ReferenceOptions& options, const Scene& scene,
                                                 const Image& image, const Metadata& metadata,
                                                 bool quiet = false) {
    const ScreenLook look = screen_look(options.screen, scene);
    std::optional<float> exposure = look.exposure;
    const bool replaces = is_filled(image);
    std::vector<std::filesystem::path> written;
    for (const std::filesystem::path& output : options.outputs) {
        if (!replaces && std::filesystem::exists(output)) {
            continue;
        }
        written.push_back(output);
        if (lower_case_extension(output) == ".exr") {
            write_image(output, image, {.metadata = metadata});
            continue;
        }
        if (!exposure) {
            exposure = automatic_exposure(image.channels, image.values);
            tell_automatic_exposure(look, *exposure, quiet);
        }
        write_image(output, image, screen_writer_options(look, *exposure, metadata));
    }
    return written;
}

/// The picture's noise: the root of the mean variance of its pixels.
double noise(const Image& image) {
    const auto first = static_cast<std::size_t>(image.find_channel("variance.R"));
    double sum = 0;
    for (std::size_t pixel = 0; pixel < image.values.size(); pixel += image.channel_count()) {
        for (std::size_t channel = first; channel < first + 3; ++channel) {
            sum += image.values[pixel + channel];
        }
    }
    return std::sqrt(sum / (3.0 * image.width * image.height));
}

nlohmann::ordered_json to_json(const ReferenceOptions& options, const Scene& scene,
                               const PathTracerSettings& settings, const Outcome& outcome,
                               std::span<const std::filesystem::path> written) {
    nlohmann::ordered_json outputs = nlohmann::ordered_json::array();
    for (const std::filesystem::path& output : written) {
        outputs.push_back(output.string());
    }
    return {{"scene", options.scene.file.string()},
            {"width", outcome.image.width},
            {"height", outcome.image.height},
            {"samples_per_pixel", settings.spp},
            {"samples_before", outcome.samples_before},
            {"max_depth", settings.max_depth},
            {"clamp_radius", settings.clamp_radius},
            {"indirect_only", settings.indirect_only},
            {"pixel_centers", settings.pixel_centers},
            {"filter", to_string(scene.camera.filter.kind)},
            {"glass", glass_name(scene.clear_glass)},
            {"seed", settings.seed},
            {"seconds",
             {{"load", outcome.load_seconds},
              {"render", outcome.render_seconds},
              {"total", outcome.load_seconds + outcome.render_seconds}}},
            {"noise", noise(outcome.image)},
            {"complete", !outcome.stopped},
            {"outputs", outputs}};
}

/// Finds out before hours of rendering whether the outputs can be written.
void check_outputs(const std::vector<std::filesystem::path>& outputs) {
    for (const std::filesystem::path& output : outputs) {
        ImageWriter not_committed(output, 1, 1, {"R", "G", "B"});
        not_committed.write_rows(std::array{0.0f, 0.0f, 0.0f});  // prevents a warning of libpng
    }
}

/// The output to resume from: the first one that keeps all layers.
const std::filesystem::path& output_to_resume(const ReferenceOptions& options) {
    const auto found = std::ranges::find(options.outputs, ".exr", lower_case_extension);
    if (found == options.outputs.end()) {
        throw Error(ErrorKind::invalid_argument, "--resume needs an output whose name ends in .exr");
    }
    return *found;
}

/// Loads the stored reference, if there is one, and sets its batch size and at least its number of samples.
std::optional<StoredReference> resume(const ReferenceOptions& options, const Scene& scene,
                                      PathTracerSettings& settings, Outcome& outcome) {
    std::optional<StoredReference> stored =
        read_stored_reference(output_to_resume(options), completed(settings, scene.camera), scene);
    if (stored) {
        settings.batch_size = stored->batch_size;
        settings.spp = std::max(settings.spp, stored->samples);
        outcome.samples_before = stored->samples;
        outcome.earlier_seconds = stored->render_seconds;
        spdlog::info("resuming after {} samples per pixel", stored->samples);
    }
    return stored;
}

/// Renders the picture and fills in the outcome. Every few minutes the unfinished picture is written to the
/// outputs.
void trace(const ReferenceOptions& options, const GlobalOptions& global, const Scene& scene,
           const PathTracerSettings& settings, const StoredReference* stored, Outcome& outcome) {
    const Stopwatch watch;
    const auto save = [&](const Image& image) {
        write_outputs(options, scene, image,
                      make_metadata(settings, scene, outcome.earlier_seconds + watch.seconds(), false), true);
    };
    catch_interrupts();
    ProgressBar bar("path tracing", global);
    const auto progress = [&bar](double fraction) {
        bar.update(fraction);
        return !interrupted();
    };
    outcome.image = trace_paths(scene, settings, progress,
                                {.earlier = stored != nullptr ? &stored->image : nullptr, .save = save});
    outcome.stopped = interrupted();
    outcome.render_seconds = watch.seconds();
}

ExitCode run_reference(const ReferenceOptions& options, const GlobalOptions& global) {
    check_screen_options(options.screen);
    check_outputs(options.outputs);
    Outcome outcome;
    const Stopwatch load_watch;
    const Scene scene = load_scene(options.scene);
    outcome.load_seconds = load_watch.seconds();

    PathTracerSettings settings = make_settings(options, scene);
    const std::optional<StoredReference> stored =
        options.resume ? resume(options, scene, settings, outcome) : std::nullopt;
    settings = completed(settings, scene.camera);
    trace(options, global, scene, settings, stored ? &*stored : nullptr, outcome);

    const std::vector<std::filesystem::path> written = write_outputs(
        options, scene, outcome.image,
        make_metadata(settings, scene, outcome.earlier_seconds + outcome.render_seconds, !outcome.stopped));
    for (const std::filesystem::path& output : written) {
        spdlog::info("wrote {}{}", output.string(), outcome.stopped ? " with the samples so far" : "");
    }
    if (written.size() < options.outputs.size()) {
        spdlog::info("interrupted before all pixels had a sample; older pictures were kept");
    }
    if (global.json) {
        print_json(to_json(options, scene, settings, outcome, written));
    }
    return outcome.stopped ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace

void add_reference_command(CommandLine& line) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App& command = line.add_command(
        "reference", "Path-trace a scene on the CPU: the reference that every sampler converges to",
        [options](const GlobalOptions& global) { return run_reference(*options, global); });
    add_scene_options(command, options->scene);
    command
        .add_option("-o,--output", options->outputs,
                    "Picture to write: .exr (all layers) or .png; may be given several times")
        ->type_name("OUT")
        ->required()
        ->allow_extra_args(false);
    add_screen_options(command, options->screen);
    command
        .add_option("--spp", options->spp,
                    "Samples per pixel, rounded up to a multiple of 4 from 32 on, and of 16 from 256 on "
                    "(default: the scene's, or " +
                        std::to_string(kDefaultSpp) + ")")
        ->check(CLI::Range(1, 1 << 24))
        ->type_name("N");
    command
        .add_option("--clamp-radius", options->clamp_radius,
                    "Clamp radius, in m: bound 1/r² below this distance; 0 bounds nothing")
        ->check(number_from(0, kMaxLength))
        ->type_name("R")
        ->capture_default_str();
    command.add_flag("--indirect-only", options->indirect_only, "Leave out emission and direct light");
    command.add_flag("--pixel-centers", options->pixel_centers,
                     "Send all samples through the centres of pixels, as `nearlight render --spp 1` does");
    command
        .add_option(
            "--max-depth", options->max_depth,
            "Maximum path depth: 2 is direct light only, 0 is unlimited (default: the scene's, or 256)")
        ->check(CLI::Range(0, static_cast<int>(kMaxPathDepth)))
        ->type_name("N");
    add_scene_size_option(command, options->size);
    add_filter_option(command, options->scene.filter);
    add_glass_option(command, options->scene.clear_glass);
    command.add_flag("--resume", options->resume,
                     "Resume the EXR output, if it exists, until it has --spp samples per pixel; its scene, "
                     "size and options must be the same");
    add_seed_option(command, options->seed);
    command.add_option("--threads", options->threads, "CPU threads; 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace nearlight::core
