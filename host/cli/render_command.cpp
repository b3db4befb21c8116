// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_command.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <utility>

#include "host/base/stopwatch.h"
#include "host/bvh/thread_limit.h"
#include "host/cli/checkpoint_options.h"
#include "host/cli/device_options.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/matte_layers.h"
#include "host/cli/method_options.h"
#include "host/cli/output.h"
#include "host/cli/pass_options.h"
#include "host/cli/picture_files.h"
#include "host/cli/picture_keeper.h"
#include "host/cli/progress_bar.h"
#include "host/cli/render_output.h"
#include "host/cli/rendered_picture.h"
#include "host/cli/scene_options.h"
#include "host/cli/tev_picture.h"
#include "host/cli/vpl_options.h"
#include "host/session/passes.h"
#include "host/session/picture_window.h"
#include "host/session/render.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {
namespace {

struct RenderOptions {
    SceneOptions scene;
    PictureOptions picture;
    DeviceChoice device;
    RenderSettings settings;
    SessionOptions session;
    ImageSize size;
    MethodTexts method;
    PassOptions passes;
    VplFiles vpl_files;
    CheckpointOptions checkpoint;
    std::string tev;
    int threads = 0;  ///< 0: one per core
};

/// Maximum number of pixels. With 2^30 pixels and all layers a file has up to 64 GiB, or 96 GiB with
/// --exr-precision float; a larger size is probably a typing error.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;

RenderSettings settled(const RenderOptions& options) {
    RenderSettings settings = options.settings;
    settings.passes = options.passes.passes;
    settings.seconds = options.passes.seconds;
    settings.error = options.passes.error;
    settings.pass_samples = options.passes.pass_samples;
    settle(options.method, settings);
    settle(options.vpl_files, settings);
    if (options.size.width > 0) {
        settings.view.width = options.size.width;
        settings.view.height = options.size.height;
    }
    return settings;
}

/// Warns about questionable requests, and refuses pictures of more than kMaxPixels.
void check_request(const Scene& scene, const RenderSettings& settings) {
    const int width = settings.view.width.value_or(scene.camera.width);
    const int height = settings.view.height.value_or(scene.camera.height);
    if (std::int64_t{width} * height > kMaxPixels) {
        throw Error(ErrorKind::out_of_memory,
                    fmt::format("{}x{} pixels are too many: the maximum is {} million", width, height,
                                kMaxPixels >> 20));
    }
    window_of(static_cast<uint>(width), static_cast<uint>(height), settings.gather.window);
    if (settings.sampling.vpl_count == 0 && settings.sampling.file.empty()) {
        spdlog::warn("with --vpls 0 the picture has no indirect light");
    }
}

void tell(const RenderOptions& options, const RenderReport& report, bool lacks_mattes, bool has_checkpoint,
          double seconds) {
    spdlog::info("{}x{} pixels, {} close and {} distant VPLs{}, {:.1f} s", report.width, report.height,
                 report.totals.close_vpls, report.totals.distant_vpls,
                 report.passes > 1 ? fmt::format(" in {} passes", report.passes) : "", seconds);
    tell_limits(options.passes, report, min_pass_samples(options.settings.gather), seconds);
    tell_shares(report);
    const char* const note = lacks_mattes          ? " (interrupted: mattes of the last rows are missing)"
                             : !report.interrupted ? ""
                             : report.passes > 1   ? " (interrupted: the last pass is incomplete)"
                                                   : " (interrupted: rows that were not rendered are black)";
    for (const auto& output : options.picture.outputs) {
        spdlog::info("wrote {}{}", output, note);
    }
    if (has_checkpoint) {
        spdlog::info("wrote {}{}", options.checkpoint.file.string(),
                     report.interrupted ? ", from which --resume goes on" : "");
    }
}

/// Where in the whole picture the part is that --crop names.
std::optional<ImagePlace> place_of(const GatherSettings& settings, const View& view) {
    if (!settings.window) {
        return std::nullopt;
    }
    return ImagePlace{.x = static_cast<int>(settings.window->x),
                      .y = static_cast<int>(settings.window->y),
                      .whole_width = static_cast<int>(view.camera.width),
                      .whole_height = static_cast<int>(view.camera.height)};
}

/// Logs the device time of each kernel.
void tell_kernel_times(const std::vector<std::unique_ptr<Device>>& devices) {
    for (const auto& device : devices) {
        spdlog::debug("kernels on {}:", device->entry().label());
        for (const auto& [kernel, total] : device->profiler().totals()) {
            spdlog::debug("{:<24} {:8.3f} s in {} launches", kernel, total.seconds, total.launches);
        }
    }
}

std::vector<Device*> plain(const std::vector<std::unique_ptr<Device>>& devices) {
    std::vector<Device*> result;
    std::ranges::transform(devices, std::back_inserter(result), &std::unique_ptr<Device>::get);
    return result;
}

/// What is there before the first rows come.
struct RenderRun {
    const RenderOptions& options;
    const GlobalOptions& global;
    RenderSettings settings;
    std::unique_ptr<const Scene> scene{};
    double load_seconds = 0.0;
    std::shared_future<std::uint64_t> hash{};  ///< of the scene
    std::vector<std::unique_ptr<Device>> devices{};

    [[nodiscard]] ScreenLook look() const { return screen_look(options.picture.screen, *scene); }
    [[nodiscard]] std::vector<MatteLayer> mattes() const { return matte_layers(options.picture.layers); }
    [[nodiscard]] Metadata metadata(const RenderReport& report, const View& view) const {
        Metadata metadata =
            render_metadata(hash.get(), options.scene, settings, report, view, devices, global.command_line);
        metadata["nearlight:firstPass"] = static_cast<int>(options.checkpoint.first_pass);
        return metadata;
    }
    /// What checkpoints say of the picture; nothing if there are none.
    [[nodiscard]] CheckpointFacts facts() const {
        return options.checkpoint.file.empty()
                   ? CheckpointFacts()
                   : checkpoint_facts(*scene, hash.get(), settings, options.session, devices);
    }
};

/// Reads the scene while devices start and kernels compile. Errors of the scene are reported first.
RenderRun get_ready(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice) {
    RenderRun run{.options = options, .global = global, .settings = settled(options)};
    auto opening = std::async(std::launch::async, [&] {
        auto opened = open_devices(choice, list_devices());
        begin_compiling(plain(opened), options.session, run.settings.sampling);
        return opened;
    });
    const Stopwatch loading;
    run.scene = std::make_unique<const Scene>(load_scene(options.scene));
    run.load_seconds = loading.seconds();
    check_request(*run.scene, run.settings);
    // The hash is for metadata and checkpoints, and computed in the background.
    run.hash = std::async(std::launch::async, [scene = run.scene.get()] { return scene_hash(*scene); });
    run.devices = opening.get();
    return run;
}

/// The mattes of all passes that the report counts.
MatteSource mattes_of(Session& session, const RenderRun& run, const RenderReport& report,
                      const Camera& camera, const std::function<void(double fraction)>& tell_progress) {
    std::vector<MattePass> passes;
    for (const uint samples : report.pass_samples) {
        const uint number = run.options.checkpoint.first_pass + static_cast<uint>(passes.size());
        passes.push_back({.seed = pass_seed(run.settings.seed, number), .samples_per_pixel = samples});
    }
    // An interrupted picture gets the mattes of the rows that it has.
    return [&session, &run, &camera, passes = std::move(passes), tell_progress,
            was_interrupted = interrupted()](const MatteSink& sink) {
        session.mattes(camera, run.settings.gather.window, passes, kinds_of(run.mattes()), sink,
                       [&](double fraction) {
                           tell_progress(fraction);
                           return was_interrupted || !interrupted();
                       });
    };
}

/// Where finished rows go, and when the first of them came.
struct RowSinks {
    RenderedPicture picture;
    TevPicture tev;
    FirstRows first_rows{};
    Camera camera{};  ///< of the picture

    void open(const RenderRun& run, const RenderReport& report, const View& view) {
        camera = view.camera;
        Metadata metadata = run.metadata(report, view);
        add_matte_attributes(run.mattes(), *run.scene, metadata);
        picture.open(report.width, report.height, std::move(metadata), run.look(),
                     place_of(run.settings.gather, view));
        tev.open(report.width, report.height);
    }
    void add_rows(std::span<const float> rows, const Stopwatch& since_begin) {
        first_rows.note(since_begin);
        picture.add_rows(rows);
        tev.add_rows(rows);
    }
};

/// Says how long an error will take, after the first pass only.
ForecastSink tell_once(ProgressBar& bar, const RenderSettings& settings) {
    return [&bar, &settings, told = false](const PassForecast& forecast) mutable {
        if (!std::exchange(told, true)) {
            bar.clear();
            tell_forecast(forecast, *settings.error);
        }
    };
}

/// Keeps the picture and the checkpoint on disk up to date.
PictureKeeper make_keeper(Session& session, const RenderRun& run, const CheckpointFacts& facts,
                          RowSinks& sinks, ProgressBar& bar, const Stopwatch& total) {
    return {run.options.checkpoint.file,
            run.options.checkpoint.seconds,
            {.facts =
                 [&](const PassesSoFar& so_far) {
                     CheckpointFacts now = facts;
                     now.metadata = run.metadata(so_far.report, so_far.view);
                     now.look = run.look();
                     now.place = place_of(run.settings.gather, so_far.view);
                     return now;
                 },
             .write_picture =
                 [&](const PassesSoFar& so_far) {
                     sinks.open(run, so_far.report, so_far.view);
                     so_far.average.send([&](std::span<const float> rows) { sinks.add_rows(rows, total); });
                     sinks.picture.commit(
                         total, true, mattes_of(session, run, so_far.report, sinks.camera, [](double) {}));
                 },
             .warn =
                 [&](const std::string& why) {
                     bar.clear();
                     spdlog::warn("{}; the render goes on", why);
                 }}};
}

/// Prints and logs what has become of the picture.
void tell_outcome(const RenderRun& run, const RenderReport& report, const RowSinks& sinks,
                  bool has_checkpoint, const Stopwatch& total) {
    const RenderOptions& options = run.options;
    if (run.global.json) {
        nlohmann::ordered_json json =
            render_json(options.scene, options.picture.outputs, run.settings, options.session.bvh_quality,
                        report, sinks.picture, run.load_seconds, sinks.first_rows, run.devices);
        json["first_pass"] = options.checkpoint.first_pass;
        json["checkpoint"] =
            has_checkpoint ? nlohmann::ordered_json(options.checkpoint.file.string()) : nullptr;
        print_json(json);
    }
    if (run.global.verbose) {
        tell_kernel_times(run.devices);
    }
    tell(options, report, sinks.picture.lacks_mattes(), has_checkpoint, total.seconds());
}

ExitCode run_render(const RenderOptions& options, const GlobalOptions& global) {
    check_variance_is_known(options.picture, settled(options));
    const ThreadLimit limit(options.threads);
    if (options.threads > 0) {
        limit_driver_threads(options.threads);
    }
    const DeviceChoice choice = with_compile_workers(options.device);
    check_outputs(options.picture);
    check_checkpoint(options.checkpoint, options.picture.outputs);
    std::optional<CheckpointReader> reader = open_checkpoint(options.checkpoint);
    const Stopwatch total;
    RowSinks sinks{
        .picture = RenderedPicture(options.picture, options.threads),
        .tev = TevPicture(options.tev,
                          std::filesystem::path(options.picture.outputs.front()).filename().string())};
    RenderRun run = get_ready(options, global, choice);
    const CheckpointFacts facts = run.facts();
    PassStart start = pass_start(options.checkpoint, reader, facts, run.settings);
    if (options.passes.seconds) {
        run.settings.seconds = *options.passes.seconds - total.seconds();
    }
    catch_interrupts();
    ProgressBar bar("gathering", global);
    Session session(plain(run.devices), *run.scene, options.session);
    PictureKeeper keeper = make_keeper(session, run, facts, sinks, bar, total);
    RenderReport report = render(
        session, run.settings,
        [&](const RenderReport& started, const View& view, const VplSet& vpls) {
            save(options.vpl_files, session, view, vpls);
            sinks.open(run, started, view);
        },
        [&](std::span<const float> rows) { sinks.add_rows(rows, total); },
        [&](const std::string&, double fraction) {
            bar.update(fraction);
            return !interrupted();
        },
        tell_once(bar, run.settings), std::move(start),
        [&](const PassesSoFar& so_far) { keeper.watch(so_far); });
    bar.clear();
    bar.start("counting mattes");
    sinks.picture.commit(
        total, false, mattes_of(session, run, report, sinks.camera, [&](double done) { bar.update(done); }));
    bar.clear();
    report.interrupted = report.interrupted || sinks.picture.lacks_mattes();
    keeper.check();
    tell_outcome(run, report, sinks, keeper.has_checkpoint(), total);
    return report.interrupted ? ExitCode::interrupted : ExitCode::done;
}

/// `--preview` sets what other options stand for too. It must be added before them, because options take
/// effect in the order in which they are added, and what the user asks for by name prevails.
void add_preview_option(CLI::App& command, RenderOptions& options) {
    command.add_flag_callback(
        "--preview",
        [&options] {
            options.settings.sampling.vpl_count = 500;
            options.settings.gather.samples_per_pixel = 1;
            options.settings.gather.interleave = 4;
            options.settings.view.ray_budget_pilot = false;
            options.settings.gather.direct_samples_per_pixel = 1;
            options.settings.gather.rays_per_pixel = 1;
            options.picture.denoise_fast = true;
        },
        "A quick picture, best with --denoise: --spp 1 --vpls 500 --direct-samples 1 --rays 1, where each "
        "pixel of a square of 4x4 asks a sixteenth of the VPLs; other options prevail");
}

void add_session_options(CLI::App& command, SessionOptions& session) {
    add_choice<GatherKernel>(command, "--gather", session.gather_kernel,
                             {kGatherKernels.begin(), kGatherKernels.end()},
                             "Gather kernel: packets (for CPUs), rays (for GPUs) or auto")
        ->default_str(to_string(session.gather_kernel));
    add_bvh_option(command, session.bvh_quality);
}

}  // namespace

void add_render_command(CommandLine& line) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App& command = line.add_command(
        "render", "Render a scene with virtual point lights", [options](const GlobalOptions& global) {
            if (options->picture.outputs.empty()) {
                options->picture.outputs = {default_output(options->scene.file)};
            }
            return run_render(*options, global);
        });
    add_preview_option(command, *options);
    options->picture.offers_mattes = true;
    add_scene_options(command, options->scene);
    add_picture_options(command, options->picture);
    add_size_option(command, options->size);
    command
        .add_option_function<std::string>(
            "--crop",
            [options](const std::string& text) { options->settings.gather.window = parse_window(text); },
            "Render this part of the picture only: its size, and its place from the left and from the top, "
            "as in 320x240+100+50")
        ->type_name("WxH+X+Y");
    add_filter_option(command, options->scene.filter);
    add_glass_option(command, options->scene.clear_glass);
    add_sample_options(command, options->settings.gather);
    command
        .add_option(
            "--strata", options->settings.gather.strata,
            "Parts of the set of VPLs. Samples of a pixel take turns to ask about one part each, which "
            "counts for all; 1: each sample asks about all VPLs (default: as many as --spp)")
        ->check(CLI::Range(1u, 65536u))
        ->type_name("N");
    add_pass_options(command, options->passes);
    add_tev_option(command, options->tev);
    add_sampler_options(command, options->settings, options->method);
    add_vpl_options(command, options->vpl_files);
    add_checkpoint_options(command, options->checkpoint);
    add_method_options(command, options->settings, options->method);
    add_session_options(command, options->session);
    add_device_options(command, options->device);
    command
        .add_option("--threads", options->threads,
                    "CPU threads for building trees and for PoCL's CPU device (other CPU drivers ignore "
                    "this); 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace nearlight::core
