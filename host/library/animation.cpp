// SPDX-License-Identifier: Apache-2.0
#include "nearlight/animation.h"

#include <utility>

#include "host/library/checks.h"
#include "host/library/parts.h"
#include "host/library/states.h"
#include "host/session/frame_sequence.h"
#include "nearlight/error.h"

namespace nearlight {
namespace {

core::FrameSource source_of(const std::filesystem::path& file, const LoadOptions& options) {
    return {.load = [file, options](
                        const core::SceneMoment& moment) { return load_core_scene(file, options, moment); },
            .camera_at =
                [options](const core::Scene& scene, const core::SceneMoment& moment) {
                    return core::camera_at(scene, core_options(options, moment));
                }};
}

void refuse_wandering_target(const LoadOptions& options) {
    if (options.origin && !options.target) {
        throw Error(
            ErrorKind::invalid_argument,
            "an animation with an origin needs a target too, because the middle of the scene may move",
            "target");
    }
}

}  // namespace

struct Animation::State {
    State(std::shared_ptr<Devices::State> on_devices, const std::filesystem::path& file,
          const AnimationOptions& options, const LoadOptions& load, const SessionOptions& session)
        : devices(std::move(on_devices)),
          scene(std::make_unique<core::Scene>(load_core_scene(file, load, core::moment_of(options, 0)))),
          span(scene->animation.value()),
          sequence(source_of(file, load), options, devices->plain(), session, scene) {}

    std::shared_ptr<Devices::State> devices;
    std::unique_ptr<core::Scene> scene;
    core::TimeSpan span;
    core::FrameSequence sequence;  ///< declared last, because it refers to the others
};

Animation::Animation(const Devices& devices, const std::filesystem::path& file,
                     const AnimationOptions& options, const LoadOptions& load,
                     const SessionOptions& session) {
    check(options);
    refuse_wandering_target(load);
    state_ = std::make_unique<State>(devices.state_, file, options, load, session);
}
Animation::~Animation() = default;
Animation::Animation(Animation&&) noexcept = default;
Animation& Animation::operator=(Animation&&) noexcept = default;

double Animation::begin() const {
    return state_->span.begin;
}

double Animation::end() const {
    return state_->span.end;
}

Picture Animation::render(int frame, const RenderSettings& settings, const Progress& progress) {
    check_frame(frame);
    check(settings);
    core::FrameSequence& sequence = state_->sequence;
    sequence.go_to(frame, settings.view, settings.sampling);
    return render_picture(sequence.session(), settings, progress, sequence.vpl_maker());
}

}  // namespace nearlight
