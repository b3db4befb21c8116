// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_frames.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/image/exposure_meter.h"
#include "host/session/key_vpls.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

/// The options of one frame.
RenderOptions options_of(const RenderOptions& options, int frame) {
    RenderOptions result = options;
    result.picture.outputs = numbered(options.picture.outputs, frame);
    result.scene.moment = options.frames.moment(frame);
    return result;
}

void check_frames(const RenderOptions& options) {
    const SceneOverrides& overrides = options.scene.overrides;
    if (overrides.origin && !overrides.target) {
        throw Error(ErrorKind::invalid_argument,
                    "--frames with --origin needs --target too, because the middle of the scene may move");
    }
}

/// The scene and what is made for it, from one frame to the next.
class Walk {
  public:
    Walk(RenderRun& run, const RenderOptions& options)
        : run_(run), options_(options), vpls_(run.settings.view) {}

    /// Goes to a frame; the first one must be that at which the run's scene was loaded.
    void go_to(int frame);
    [[nodiscard]] Session& session() { return *session_; }
    /// Empty if the frame has VPLs of its own.
    [[nodiscard]] VplMaker vpl_maker();
    /// The exposure that the first moment of the animation asks for, in stops, which frames share so that
    /// their brightness does not flicker.
    float exposure();

  private:
    void load(int frame);
    /// The camera at a frame, if its light is that of the present one.
    std::optional<SceneCamera> camera_at_frame(int frame);
    std::vector<KeyView> key_views(int frame);

    RenderRun& run_;
    const RenderOptions& options_;
    std::optional<Session> session_;
    std::map<int, std::optional<SceneCamera>> cameras_;  ///< of the key frames about the present one
    KeyVpls vpls_;
};

void Walk::load(int frame) {
    session_.reset();
    cameras_.clear();
    run_.hash.wait();
    run_.scene.reset();
    run_.scene = std::make_unique<Scene>(load_scene(options_of(options_, frame).scene));
}

std::optional<SceneCamera> Walk::camera_at_frame(int frame) {
    return camera_at(*run_.scene, options_of(options_, frame).scene);
}

void Walk::go_to(int frame) {
    const Stopwatch loading;
    const bool is_first = !session_;
    if (!is_first) {
        if (const std::optional<SceneCamera> camera = camera_at_frame(frame)) {
            run_.hash.wait();
            run_.scene->camera = *camera;
        } else {
            load(frame);
        }
        run_.load_seconds = loading.seconds();
        run_.begin_hash();
    }
    if (!session_) {
        session_.emplace(run_.plain_devices(), *run_.scene, options_.session);
        if (!is_first) {
            static_cast<void>(session_->new_compile_seconds());  // earlier frames have counted them
        }
    }
    const RenderOptions of_frame = options_of(options_, frame);
    run_.options.picture.outputs = of_frame.picture.outputs;
    run_.options.scene.moment = of_frame.scene.moment;
    std::vector<KeyView> views = key_views(frame);
    run_.frame = FrameFacts{.frame = frame};
    for (const KeyView& view : views) {
        std::string& text = run_.frame->vpl_keys;
        text += fmt::format("{}{}:{:.4g}", text.empty() ? "" : " ", view.frame, view.weight);
    }
    vpls_.set_views(std::move(views));
}

/// The key views before and after the frame in which the light is the same, weighted by how near they are.
std::vector<KeyView> Walk::key_views(int frame) {
    const SamplingSettings& sampling = run_.settings.sampling;
    const int step = options_.frames.key_step();
    if (step == 0 || sampling.sampler == SamplerKind::local || !sampling.file.empty()) {
        return {};
    }
    const int before = frame / step * step;
    std::erase_if(cameras_, [before](const auto& entry) { return entry.first < before; });
    std::vector<KeyView> views;
    for (const int key : {before, before + step}) {
        const float weight = 1.0f - static_cast<float>(std::abs(frame - key)) / static_cast<float>(step);
        if (weight > 0.0f) {
            const auto [entry, is_new] = cameras_.try_emplace(key);
            if (is_new) {
                entry->second = camera_at_frame(key);
            }
            if (entry->second) {
                views.push_back({.frame = key, .camera = *entry->second, .weight = weight});
            }
        }
    }
    // Between two equal views the picture would still change, because samples take turns among all VPLs.
    if (views.size() == 2 && views[0].camera.to_world.m == views[1].camera.to_world.m) {
        views.pop_back();
    }
    if (views.size() == 1) {
        views.front().weight = 1.0f;
    }
    return views;
}

VplMaker Walk::vpl_maker() {
    if (!vpls_.has_views()) {
        return {};
    }
    return [this](const ViewSettings& view, const SamplingSettings& sampling, uint seed) {
        return vpls_.make(*session_, view, sampling, seed);
    };
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

float Walk::exposure() {
    SceneOptions begin = options_.scene;
    begin.moment = SceneMoment{run_.scene->animation->begin, options_.frames.animations};
    if (const std::optional<SceneCamera> camera = camera_at(*run_.scene, begin)) {
        return metered(*session_, *camera, run_.settings);
    }
    const Scene scene = load_scene(begin);
    Session session(run_.plain_devices(), scene, options_.session);
    return metered(session, scene.camera, run_.settings);
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
        Walk walk(run, options);
        Stopwatch total = whole;
        for (const int frame : frames) {
            if (interrupted()) {
                break;
            }
            walk.go_to(frame);
            if (frame == frames.front() && has_screen_pictures(options.picture) && !run.look().exposure) {
                run.options.picture.screen.exposure = fmt::format("{}", walk.exposure());
                if (interrupted()) {
                    break;
                }
            }
            if (options.passes.seconds) {
                run.settings.seconds = *options.passes.seconds - total.seconds();
            }
            sinks.picture.set_outputs(run.options.picture.outputs);
            sinks.first_rows = {};
            MadePicture picture = make_picture(walk.session(), run, {.vpls = walk.vpl_maker()}, sinks, total);
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
