// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_run.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "host/cli/compile_notice.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/matte_layers.h"
#include "host/cli/picture_keeper.h"
#include "host/cli/progress_bar.h"
#include "host/session/passes.h"

namespace nearlight::core {
namespace {

/// Maximum number of pixels. With 2^30 pixels and all layers a file has up to 64 GiB, or 96 GiB with
/// --exr-precision float; a larger size is probably a typing error.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 30;

/// The part of the picture that is rendered. Throws Error(ErrorKind::invalid_argument) if it is not within
/// it.
PixelWindow window_in(const Scene& scene, const RenderSettings& settings) {
    return window_of(static_cast<uint>(settings.view.width.value_or(scene.camera.width)),
                     static_cast<uint>(settings.view.height.value_or(scene.camera.height)),
                     settings.gather.window);
}

/// Warns about questionable requests, and refuses pictures of more than kMaxPixels.
void check_request(const Scene& scene, const RenderSettings& settings) {
    const int width = settings.view.width.value_or(scene.camera.width);
    const int height = settings.view.height.value_or(scene.camera.height);
    if (std::int64_t{width} * height > kMaxPixels) {
        throw Error(ErrorKind::out_of_memory,
                    fmt::format("{}x{} pixels are too many: the maximum is {} million", width, height,
                                kMaxPixels >> 20),
                    "size");
    }
    static_cast<void>(window_in(scene, settings));
    if (settings.sampling.vpl_count == 0 && settings.sampling.file.empty()) {
        spdlog::warn("with --vpls 0 the picture lacks the indirect light that VPLs bring");
    }
}

void tell(const RenderRun& run, const RenderReport& report, bool lacks_mattes, bool has_checkpoint,
          double seconds) {
    const RenderOptions& options = run.options;
    spdlog::info("{}{}x{} pixels, {} close and {} distant VPLs{}, {:.1f} s",
                 run.frame ? fmt::format("frame {}: ", run.frame->frame) : "", report.width, report.height,
                 report.totals.close_vpls, report.totals.distant_vpls,
                 report.passes > 1 ? fmt::format(" in {} passes", report.passes) : "", seconds);
    warn_of_unknown_variance(options.picture, report.pass_samples);
    tell_limits(options.passes, report, min_pass_samples(options.settings.gather), seconds);
    tell_shares(report);
    const char* const note = lacks_mattes          ? " (interrupted: mattes of the last rows are missing)"
                             : !report.interrupted ? ""
                             : report.passes > 1   ? " (interrupted: the last pass is incomplete)"
                                                   : " (interrupted: rows that were not rendered are black)";
    if (run.frame && report.interrupted) {
        return;
    }
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

/// The mattes of all passes that the report counts.
MatteSource mattes_of(Session& session, const RenderRun& run, const RenderReport& report,
                      const Camera& camera, bool spread_single_samples,
                      const std::function<void(double fraction)>& tell_progress) {
    std::vector<MattePass> passes;
    for (const uint samples : report.pass_samples) {
        const uint number = run.options.checkpoint.first_pass + static_cast<uint>(passes.size());
        passes.push_back({.seed = pass_seed(run.settings.seed, number),
                          .samples_per_pixel = samples,
                          .spread_single_samples = spread_single_samples});
    }
    // An interrupted picture gets the mattes of the rows that it has, and a frame all of them.
    return [&session, &run, &camera, passes = std::move(passes), tell_progress,
            goes_on = interrupted() || run.frame](const MatteSink& sink) {
        session.mattes(camera, run.settings.gather.window, passes, kinds_of(run.mattes()), sink,
                       [&](double fraction) {
                           tell_progress(fraction);
                           return goes_on || !interrupted();
                       });
    };
}

/// How many passes a picture has, where limits of time or error do not decide it.
int known_passes(const RenderSettings& settings) {
    const std::size_t listed = settings.pass_samples.size();
    return listed > 0         ? static_cast<int>(listed)
           : settings.error   ? 0
           : settings.seconds ? 1
                              : static_cast<int>(settings.passes.value_or(1));
}

/// Says how long an error will take, after the first pass only.
ForecastSink tell_once(ProgressBar& bar, std::string label, const RenderSettings& settings,
                       double seconds_before) {
    return [&bar, &settings, label = std::move(label), seconds_before,
            told = false](PassForecast forecast) mutable {
        if (!std::exchange(told, true)) {
            bar.start(std::move(label), 1);
            forecast.seconds += seconds_before;
            tell_forecast(forecast, *settings.error);
        }
    };
}

/// The time limit of the options begins with the command, that of a render when it is called.
RenderSettings in_time_left(RenderSettings settings, double seconds_before) {
    if (settings.seconds) {
        settings.seconds = std::max(0.0, *settings.seconds - seconds_before);
    }
    return settings;
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
                         total, so_far.report.pass_samples, true,
                         mattes_of(session, run, so_far.report, sinks.camera, true, [](double) {}));
                 },
             .warn =
                 [&](const std::string& why) {
                     bar.clear();
                     spdlog::warn("{}; the render goes on", why);
                 }}};
}

/// The object that --json prints of the picture.
nlohmann::ordered_json json_of(const RenderRun& run, const RenderReport& report, const RowSinks& sinks,
                               bool has_checkpoint) {
    const RenderOptions& options = run.options;
    nlohmann::ordered_json json = render_json(
        {.scene = options.scene,
         .outputs = sinks.are_written(report) ? options.picture.outputs : std::vector<std::string>(),
         .settings = run.settings,
         .bvh = options.session.bvh_quality,
         .report = report,
         .picture = sinks.picture,
         .load_seconds = run.load_seconds,
         .first_rows = sinks.first_rows,
         .devices = run.devices});
    json["first_pass"] = options.checkpoint.first_pass;
    json["checkpoint"] = has_checkpoint ? nlohmann::ordered_json(options.checkpoint.file.string()) : nullptr;
    if (run.frame) {
        json["frame"] = run.frame->frame;
        json["vpl_keys"] = run.frame->vpl_keys;
    }
    return json;
}

/// What is left of the time that the picture may take. Nothing if it may take any, or if that time is over:
/// then a pass that takes longer is made to its end.
std::optional<double> seconds_left(const RenderRun& run, const Stopwatch& since_begin) {
    const std::optional<double>& limit = run.options.passes.seconds;
    const double left = limit.value_or(0.0) - since_begin.seconds();
    return left > 0.0 ? std::optional(left) : std::nullopt;
}

std::string bar_label(const RenderRun& run) {
    return run.frame ? "frame " + std::to_string(run.frame->frame) : "gathering";
}

}  // namespace

RenderSettings settled(const RenderOptions& options) {
    RenderSettings settings = options.settings;
    settings.passes = options.passes.passes;
    settings.seconds = options.passes.seconds;
    settings.error = options.passes.error;
    settings.pass_samples = options.passes.pass_samples;
    // Denoisers want noise that neighbours do not share, and mattes have samples of each pixel's own.
    const bool wants_own = options.picture.denoise || !matte_layers(options.picture.layers).empty();
    settings.gather.splat = options.splat.empty() ? !wants_own : options.splat == "on";
    settle(options.method, settings);
    settle(options.vpl_files, settings);
    if (options.size.width > 0) {
        settings.view.width = options.size.width;
        settings.view.height = options.size.height;
    }
    return settings;
}

std::vector<Device*> RenderRun::plain_devices() const {
    return plain(devices);
}

Metadata RenderRun::metadata(const RenderReport& report, const View& view) const {
    Metadata metadata =
        render_metadata(hash.get(), options.scene, settings, report, view, devices, global.command_line);
    metadata["nearlight:firstPass"] = static_cast<int>(options.checkpoint.first_pass);
    if (frame) {
        metadata["nearlight:frame"] = frame->frame;
        metadata["nearlight:vplKeys"] = frame->vpl_keys.empty() ? "none" : frame->vpl_keys;
    }
    return metadata;
}

PixelWindow RenderRun::window() const {
    return window_in(*scene, settings);
}

CheckpointFacts RenderRun::facts() const {
    return options.checkpoint.file.empty()
               ? CheckpointFacts()
               : checkpoint_facts(*scene, hash.get(), settings, options.session, devices);
}

void RenderRun::begin_hash() {
    hash = std::async(std::launch::async, [of = scene.get()] { return scene_hash(*of); });
}

RenderRun get_ready(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice) {
    RenderRun run{.options = options, .global = global, .settings = settled(options)};
    auto opening = std::async(std::launch::async, [&] {
        auto opened = open_devices(choice, list_devices());
        begin_compiling(plain(opened), options.session, run.settings.sampling);
        return opened;
    });
    const Stopwatch loading;
    run.scene = std::make_unique<Scene>(load_scene(options.scene));
    run.load_seconds = loading.seconds();
    check_request(*run.scene, run.settings);
    run.begin_hash();
    run.devices = opening.get();
    return run;
}

RowSinks::RowSinks(const RenderOptions& options)
    : picture(options.picture, options.threads),
      tev(options.tev, std::filesystem::path(options.picture.outputs.front()).filename().string()) {}

void RowSinks::open(const RenderRun& run, const RenderReport& report, const View& view) {
    camera = view.camera;
    Metadata metadata = run.metadata(report, view);
    add_matte_attributes(run.mattes(), *run.scene, metadata);
    picture.open(report.width, report.height, std::move(metadata), run.look(),
                 place_of(run.settings.gather, view));
    tev.open(report.width, report.height);
}

void RowSinks::add_rows(std::span<const float> rows, const Stopwatch& since_begin) {
    first_rows.note(since_begin);
    has_rows = true;
    picture.add_rows(rows);
    tev.add_rows(rows);
}

MadePicture make_picture(Session& session, const RenderRun& run, PictureStart start, RowSinks& sinks,
                         const Stopwatch& since_begin) {
    sinks.first_rows = {};
    sinks.has_rows = false;
    auto notice = std::make_unique<CompileNotice>(*run.devices.front());
    ProgressBar bar(bar_label(run), run.global, known_passes(run.settings));
    PictureKeeper keeper = make_keeper(session, run, start.facts, sinks, bar, since_begin);
    // The file of a frame says that it is finished, so none is there before.
    const PassWatcher watcher = run.frame ? PassWatcher() : [&](const PassesSoFar& so_far) {
        sinks.first_rows.note(since_begin);
        keeper.watch(so_far);
    };
    const double seconds_before = since_begin.seconds();
    RenderHooks hooks{.forecast = tell_once(bar, bar_label(run), run.settings, seconds_before),
                      .watcher = watcher,
                      .vpls = start.vpls};
    hooks.open = [&](const RenderReport& started, const View& view, const VplSet& vpls) {
        save(run.options.vpl_files, session, view, vpls);
        sinks.open(run, started, view);
    };
    hooks.rows = [&](std::span<const float> rows) { sinks.add_rows(rows, since_begin); };
    hooks.progress = [&](double fraction) {
        notice.reset();
        bar.update(fraction, seconds_left(run, since_begin));
        return !interrupted();
    };
    const bool has_passes = averages_passes(run.settings, start.passes);
    RenderReport report =
        render(session, in_time_left(run.settings, seconds_before), hooks, std::move(start.passes));
    bar.clear();
    const bool has_rows = sinks.are_written(report);
    if (has_rows && (!run.frame || !report.interrupted)) {
        bar.start("counting mattes");
        sinks.picture.commit(since_begin, report.pass_samples, false,
                             mattes_of(session, run, report, sinks.camera, has_passes,
                                       [&](double done) { bar.update(done); }));
        bar.clear();
        report.interrupted = report.interrupted || sinks.picture.lacks_mattes();
    }
    keeper.check();
    if (run.global.verbose) {
        tell_kernel_times(run.devices);
    }
    if (has_rows) {
        tell(run, report, sinks.picture.lacks_mattes(), keeper.has_checkpoint(), since_begin.seconds());
    } else {
        spdlog::info("interrupted before the first rows; nothing was written");
    }
    return {report, json_of(run, report, sinks, keeper.has_checkpoint())};
}

}  // namespace nearlight::core
