// SPDX-License-Identifier: Apache-2.0
#include "host/session/frame_sequence.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "host/base/stopwatch.h"
#include "host/samplers/sampler.h"

namespace nearlight::core {

SceneMoment moment_of(const AnimationOptions& options, int frame) {
    return {frame / options.fps, options.animations};
}

int key_step(const AnimationOptions& options) {
    return options.vpl_keys.value_or(std::max(1, static_cast<int>(std::lround(std::min(options.fps, 1e6)))));
}

std::optional<SceneCamera> FrameSequence::camera_at(int frame) {
    return source_.camera_at(*scene_, moment_of(options_, frame));
}

void FrameSequence::load(int frame) {
    session_.reset();
    cameras_.clear();
    at_.reset();
    scene_.reset();
    scene_ = std::make_unique<Scene>(source_.load(moment_of(options_, frame)));
}

void FrameSequence::move_to(int frame) {
    if (at_ == frame) {
        return;
    }
    const Stopwatch loading;
    const std::optional<SceneCamera> camera = at_ ? camera_at(frame) : std::nullopt;
    if (source_.before_change) {
        source_.before_change();
    }
    if (camera) {
        scene_->camera = *camera;
    } else {
        load(frame);
    }
    at_ = frame;
    if (source_.after_change) {
        source_.after_change(loading.seconds());
    }
}

void FrameSequence::go_to(int frame, const ViewSettings& view, const SamplingSettings& sampling) {
    move_to(frame);
    if (!session_) {
        session_.emplace(devices_, *scene_, session_options_);
        if (std::exchange(has_begun_, true)) {
            static_cast<void>(session_->new_compile_seconds());  // earlier frames have counted them
        }
    }
    if (view != view_ || sampling != sampling_) {
        view_ = view;
        sampling_ = sampling;
        vpls_ = KeyVpls(view);
    }
    vpls_.set_views(key_views(frame, sampling));
}

/// The key views before and after the frame in which the light is the same, weighted by how near they are.
std::vector<KeyView> FrameSequence::key_views(int frame, const SamplingSettings& sampling) {
    const int step = key_step(options_);
    if (step == 0 || sampler_entry(sampling.sampler).makes_local_lights || !sampling.file.empty()) {
        return {};
    }
    const int before = frame / step * step;
    std::erase_if(cameras_,
                  [&](const auto& entry) { return entry.first != before && entry.first != before + step; });
    std::vector<KeyView> views;
    for (const int key : {before, before + step}) {
        const float weight = 1.0f - static_cast<float>(std::abs(frame - key)) / static_cast<float>(step);
        if (weight > 0.0f) {
            if (!cameras_.contains(key)) {
                cameras_.emplace(key, camera_at(key));
            }
            if (const std::optional<SceneCamera>& camera = cameras_.at(key)) {
                views.push_back({.frame = key, .camera = *camera, .weight = weight});
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

VplMaker FrameSequence::vpl_maker() {
    if (!vpls_.has_views()) {
        return {};
    }
    return [this](const ViewSettings& view, const SamplingSettings& sampling, uint seed) {
        return vpls_.make(*session_, view, sampling, seed);
    };
}

}  // namespace nearlight::core
