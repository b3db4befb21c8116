// SPDX-License-Identifier: Apache-2.0
// The frames of an animation, one after another on the same devices.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host/scene/scene_loader.h"
#include "host/session/key_vpls.h"
#include "host/session/render.h"

namespace nearlight::core {

/// The moment that a frame shows.
SceneMoment moment_of(const AnimationOptions& options, int frame);
/// Frames from one key view to the next; 0: each frame has VPLs of its own.
int key_step(const AnimationOptions& options);

/// Where a sequence of frames takes its scenes from.
struct FrameSource {
    std::function<Scene(const SceneMoment&)> load;
    /// Does what camera_at() of scene_loader.h does.
    std::function<std::optional<SceneCamera>(const Scene&, const SceneMoment&)> camera_at;
    std::function<void()> before_change{};  ///< called before the scene changes; may be empty
    /// Called after it has changed, with the seconds that took; may be empty.
    std::function<void(double seconds)> after_change{};
};

/// A scene and what is made for it, from one frame to the next. Where only the camera moves, trees and VPLs
/// stay on the devices. What a frame looks like does not depend on which others were made before.
class FrameSequence {
  public:
    /// The devices must outlive the sequence, and so must `scene`, in which the sequence keeps its scene:
    /// after go_to() it holds that frame's. If it holds a scene already, that is the one of frame `at`.
    FrameSequence(FrameSource source, AnimationOptions options, std::vector<Device*> devices,
                  const SessionOptions& session_options, std::unique_ptr<Scene>& scene, int at = 0)
        : source_(std::move(source)),
          options_(std::move(options)),
          devices_(std::move(devices)),
          session_options_(session_options),
          scene_(scene),
          at_(scene ? std::optional(at) : std::nullopt) {}

    /// Goes to a frame, whose picture is to have these settings. If it throws, it may be called again.
    void go_to(int frame, const ViewSettings& view, const SamplingSettings& sampling);
    /// The session of the frame.
    [[nodiscard]] Session& session() { return *session_; }
    /// What makes the frame's VPLs; empty if it has VPLs of its own. Refers to the sequence.
    [[nodiscard]] VplMaker vpl_maker();
    /// The key views that the frame's VPLs are for; empty if it has VPLs of its own.
    [[nodiscard]] const std::vector<KeyView>& views() const { return vpls_.views(); }

  private:
    void move_to(int frame);
    void load(int frame);
    /// The camera at a frame, if its light is that of the present one.
    std::optional<SceneCamera> camera_at(int frame);
    std::vector<KeyView> key_views(int frame, const SamplingSettings& sampling);

    FrameSource source_;
    AnimationOptions options_;
    std::vector<Device*> devices_;
    SessionOptions session_options_;
    std::unique_ptr<Scene>& scene_;
    std::optional<int> at_;  ///< the frame whose scene that is; empty: there is no scene
    bool has_begun_ = false;
    std::optional<Session> session_;                     ///< of the scene
    std::map<int, std::optional<SceneCamera>> cameras_;  ///< of the key frames about the present one
    KeyVpls vpls_{ViewSettings()};
    ViewSettings view_{};  ///< of the VPLs that are kept
    SamplingSettings sampling_{};
};

}  // namespace nearlight::core
