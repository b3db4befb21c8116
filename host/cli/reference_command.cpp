// SPDX-License-Identifier: Apache-2.0
#include "host/cli/reference_command.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/log.h"
#include "host/cli/interrupt.h"
#include "host/cli/output.h"
#include "host/cli/progress_bar.h"
#include "host/cli/scene_options.h"
#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"

namespace nearlight {
namespace {

constexpr int kDefaultSpp = 64;

struct ReferenceOptions {
    SceneOptions scene;
    std::vector<std::filesystem::path> outputs;
    ImageSize size;
    std::optional<int> spp;
    std::optional<int> max_depth;
    float clamp_radius = 0.0f;
    bool indirect_only = false;
    bool pixel_centers = false;
    std::uint64_t seed = 0;
    int threads = 0;
};

/// What came out of it.
struct Outcome {
    Image image;
    double load_seconds = 0;
    double render_seconds = 0;
    bool stopped = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

PathTracerSettings make_settings(const ReferenceOptions& options, const Scene& scene) {
    PathTracerSettings settings;
    settings.width = options.size.width;
    settings.height = options.size.height;
    const int scene_spp = scene.samples_per_pixel > 0 ? scene.samples_per_pixel : kDefaultSpp;
    settings.spp = rounded_spp(options.spp.value_or(scene_spp));
    settings.max_depth = options.max_depth.value_or(scene.max_depth);
    settings.clamp_radius = options.clamp_radius;
    settings.indirect_only = options.indirect_only;
    settings.pixel_centers = options.pixel_centers;
    settings.seed = options.seed;
    settings.threads = options.threads;
    return settings;
}

Metadata make_metadata(const PathTracerSettings& settings, const Scene& scene, const Outcome& outcome) {
    return {{"nearlight:sampler", std::string("reference")},
            {"nearlight:samplesPerPixel", settings.spp},
            {"nearlight:clampRadius", settings.clamp_radius},
            {"nearlight:indirectOnly", settings.indirect_only ? 1 : 0},
            {"nearlight:pixelCenters", settings.pixel_centers ? 1 : 0},
            {"nearlight:maxDepth", settings.max_depth},
            {"nearlight:seed", std::to_string(settings.seed)},
            {"nearlight:version", std::string(NEARLIGHT_VERSION)},
            {"nearlight:sceneHash", fmt::format("{:016x}", scene_hash(scene))},
            {"nearlight:complete", outcome.stopped ? 0 : 1},
            {"renderTimeSeconds", static_cast<float>(outcome.render_seconds)}};
}

/// Root of the mean variance of the picture's pixels; a statement about noise, not about pixels.
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

nlohmann::ordered_json to_json(const ReferenceOptions& options, const PathTracerSettings& settings,
                               const Outcome& outcome) {
    nlohmann::ordered_json outputs = nlohmann::ordered_json::array();
    for (const std::filesystem::path& output : options.outputs) {
        outputs.push_back(output.string());
    }
    return {{"scene", options.scene.file.string()},
            {"width", outcome.image.width},
            {"height", outcome.image.height},
            {"samples_per_pixel", settings.spp},
            {"max_depth", settings.max_depth},
            {"clamp_radius", settings.clamp_radius},
            {"indirect_only", settings.indirect_only},
            {"pixel_centers", settings.pixel_centers},
            {"seed", settings.seed},
            {"seconds",
             {{"load", outcome.load_seconds},
              {"render", outcome.render_seconds},
              {"total", outcome.load_seconds + outcome.render_seconds}}},
            {"noise", noise(outcome.image)},
            {"complete", !outcome.stopped},
            {"outputs", outputs}};
}

/// Hours of rendering must not end at a path that cannot be written.
void check_outputs(const std::vector<std::filesystem::path>& outputs) {
    for (const std::filesystem::path& output : outputs) {
        const ImageWriter not_committed(output, 1, 1, {"R", "G", "B"});
    }
}

ExitCode run_reference(const ReferenceOptions& options, const GlobalOptions& global) {
    check_outputs(options.outputs);
    Outcome outcome;
    const auto load_start = std::chrono::steady_clock::now();
    const Scene scene = load_scene(options.scene);
    outcome.load_seconds = seconds_since(load_start);

    const PathTracerSettings settings = make_settings(options, scene);
    const auto render_start = std::chrono::steady_clock::now();
    catch_interrupts();
    {
        ProgressBar bar("path tracing", global);
        outcome.image = trace_paths(scene, settings, [&bar](double fraction) {
            bar.update(fraction);
            return !interrupted();
        });
    }
    outcome.stopped = interrupted();
    outcome.render_seconds = seconds_since(render_start);

    for (const std::filesystem::path& output : options.outputs) {
        write_image(output, outcome.image, {.metadata = make_metadata(settings, scene, outcome)});
        spdlog::info("wrote {}{}", output.string(), outcome.stopped ? " with the samples so far" : "");
    }
    if (global.json) {
        print_json(to_json(options, settings, outcome));
    }
    return outcome.stopped ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace

void add_reference_command(CommandLine& line) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App& command =
        line.add_command("reference", "Path-trace a scene on the CPU: what every sampler converges to",
                         [options](const GlobalOptions& global) { return run_reference(*options, global); });
    add_scene_options(command, options->scene);
    command
        .add_option("-o,--output", options->outputs, "EXR (all layers) or PNG; may be given several times")
        ->type_name("OUT")
        ->required()
        ->allow_extra_args(false);
    command
        .add_option("--spp", options->spp,
                    "Samples per pixel, rounded up to whole batches of 4 or 16; "
                    "default: the scene's, or " +
                        std::to_string(kDefaultSpp))
        ->check(CLI::Range(1, 1 << 24));
    command.add_option("--clamp-radius", options->clamp_radius, "Bound 1/r² below this distance; 0: nowhere")
        ->check(CLI::NonNegativeNumber);
    command.add_flag("--indirect-only", options->indirect_only, "Leave out emission and direct light");
    command.add_flag("--pixel-centers", options->pixel_centers,
                     "Send all samples through the centres of pixels, as 'nearlight render --spp 1' does");
    command
        .add_option("--max-depth", options->max_depth,
                    "Longest path, 2: direct light only; 0: no limit; default: the scene's")
        ->check(CLI::NonNegativeNumber);
    add_size_option(command, options->size);
    command.add_option("--seed", options->seed, "Another seed, other noise");
    command.add_option("--threads", options->threads, "CPU threads; 0: one a core")
        ->check(CLI::NonNegativeNumber);
}

}  // namespace nearlight
