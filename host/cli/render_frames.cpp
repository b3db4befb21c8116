// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_frames.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/image/exposure_meter.h"
#include "host/session/frame_sequence.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

/// The options of one frame.
RenderOptions options_of(const RenderOptions& options, int frame) {
    RenderOptions result = options;
    result.picture.outputs = numbered(options.picture.outputs, frame);
    result.scene.moment = moment_of(options.frames.animation, frame);
    return result;
}

void check_frames(const RenderOptions& options) {
    const SceneOverrides& overrides = options.scene.overrides;
    if (overrides.origin && !overrides.target) {
        throw Error(ErrorKind::invalid_argument,
                    "--frames with --origin needs --target too, because the middle of the scene may move");
    }
}

/// What a run has of a sequence of frames. The scene's hash is computed in the background, where it must not
/// change.
FrameSource source_for(RenderRun& run, const RenderOptions& options) {
    const auto scene_at = [&options](const SceneMoment& moment) {
        SceneOptions scene = options.scene;
        scene.moment = moment;
        return scene;
    };
    return {.load = [scene_at](const SceneMoment& moment) { return load_scene(scene_at(moment)); },
            .camera_at = [scene_at](const Scene& scene,
                                    const SceneMoment& moment) { return camera_at(scene, scene_at(moment)); },
            .before_change = [&run] { run.hash.wait(); },
            .after_change =
                [&run](double seconds) {
                    run.load_seconds = seconds;
                    run.begin_hash();
                }};
}

/// Makes the run that of a frame.
void go_to(FrameSequence& sequence, RenderRun& run, const RenderOptions& options, int frame) {
    sequence.go_to(frame, run.settings.view, run.settings.sampling);
    const RenderOptions of_frame = options_of(options, frame);
    run.options.picture.outputs = of_frame.picture.outputs;
    run.options.scene.moment = of_frame.scene.moment;
    run.frame = FrameFacts{.frame = frame};
    for (const KeyView& view : sequence.views()) {
        std::string& text = run.frame->vpl_keys;
        text += fmt::format("{}{}:{:.4g}", text.empty() ? "" : " ", view.frame, view.weight);
    }
}

/// The exposure of a small and quick picture.
float metered(Session& session, const SceneCamera& camera, const RenderSettings& settings) {
    constexpr int kWidth = 160;
    ViewSettings small = settings.view;
    const int width = small.width.value_or(camera.width);
    const int height = small.height.value_or(camera.height);
    small.width = std::min(width, kWidth);
    small.height = std::max(1, static_cast<int>(std::int64_t{height} * *small.width / width));
    SamplingSettings sampling = settings.sampling;
    sampling.vpl_count = std::min(sampling.vpl_count, 250u);
    sampling.cuts = false;
    sampling.file.clear();
    GatherSettings gather = settings.gather;
    gather.samples_per_pixel = 4;
    gather.window.reset();
    const View view = session.look(camera, small, settings.seed);
    const VplSet vpls = session.sample(view, sampling, settings.seed);
    std::vector<float> pixels;
    session.gather(
        view, vpls, gather, settings.seed,
        [&](std::span<const float> rows) { pixels.insert(pixels.end(), rows.begin(), rows.end()); },
        [](double) { return !interrupted(); });
    return automatic_exposure(layer_channels(), pixels);
}

/// The exposure that the first moment of the animation asks for, in stops, which frames share so that their
/// brightness does not flicker.
float shared_exposure(FrameSequence& sequence, const RenderRun& run, const RenderOptions& options) {
    SceneOptions begin = options.scene;
    begin.moment = SceneMoment{run.scene->animation->begin, options.frames.animation.animations};
    if (const std::optional<SceneCamera> camera = camera_at(*run.scene, begin)) {
        return metered(sequence.session(), *camera, run.settings);
    }
    const Scene scene = load_scene(begin);
    Session session(run.plain_devices(), scene, options.session);
    return metered(session, scene.camera, run.settings);
}

/// Says what has become of the frames.
void tell_frames(std::size_t made, std::size_t wanted, const FrameRange& range, double seconds) {
    const std::size_t all = static_cast<std::size_t>(range.last - range.first) + 1;
    const std::string skipped =
        wanted < all ? fmt::format("; {} were there already", all - wanted) : std::string();
    if (made < wanted) {
        spdlog::info("interrupted: {} of {} frames are finished{}", made, wanted, skipped);
    } else {
        spdlog::info("{} frame{}, {:.1f} s{}", made, made == 1 ? "" : "s", seconds, skipped);
    }
}

}  // namespace

ExitCode render_frames(const RenderOptions& options, const GlobalOptions& global,
                       const DeviceChoice& choice) {
    check_frames(options);
    const Stopwatch whole;
    const std::vector<int> frames = frames_to_make(options.frames, options.picture.outputs);
    nlohmann::ordered_json made = nlohmann::ordered_json::array();
    if (!frames.empty()) {
        const RenderOptions first = options_of(options, frames.front());
        check_outputs(first.picture);
        show_messages_once();
        RowSinks sinks(options);
        RenderRun run = get_ready(first, global, choice);
        tell_range(options.frames, *run.scene);
        catch_interrupts();
        FrameSequence sequence(source_for(run, options), options.frames.animation, run.plain_devices(),
                               options.session, run.scene, frames.front());
        Stopwatch total = whole;
        for (const int frame : frames) {
            if (interrupted()) {
                break;
            }
            go_to(sequence, run, options, frame);
            if (frame == frames.front() && has_screen_pictures(options.picture) && !run.look().exposure) {
                const float exposure = shared_exposure(sequence, run, options);
                if (interrupted()) {
                    break;
                }
                run.options.picture.screen.exposure = fmt::format("{}", exposure);
                spdlog::info("exposure {:+.2f} stops (automatic) in all frames", exposure);
            }
            sinks.picture.set_outputs(run.options.picture.outputs);
            MadePicture picture =
                make_picture(sequence.session(), run, {.vpls = sequence.vpl_maker()}, sinks, total);
            if (picture.report.interrupted) {
                break;
            }
            made.push_back(std::move(picture.json));
            total = Stopwatch();
        }
    }
    tell_frames(made.size(), frames.size(), *options.frames.range, whole.seconds());
    const bool is_done = made.size() == frames.size();
    if (global.json) {
        print_json({{"frames", std::move(made)}, {"seconds", whole.seconds()}, {"interrupted", !is_done}});
    }
    return is_done ? ExitCode::done : ExitCode::interrupted;
}

}  // namespace nearlight::core
