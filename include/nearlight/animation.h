// SPDX-License-Identifier: Apache-2.0
// The frames of an animation: pictures of one scene at many moments.
#pragma once

#include <filesystem>
#include <memory>

#include "nearlight/device.h"
#include "nearlight/export.h"
#include "nearlight/scene.h"
#include "nearlight/session.h"
#include "nearlight/settings.h"

namespace nearlight {

/// A glTF file whose animations move its camera, its lights or its objects, on devices. Where only the camera
/// moves, scene, trees and VPLs stay there from one frame to the next, and VPLs hardly flicker; otherwise the
/// file is read again (docs/animation.md). The bits of a frame depend on file and settings, but not on which
/// frames were made before: they are those of `nearlight render --frames`.
///
/// It uses devices as a Session does: it is for one thread at a time, and its errors are a session's and
/// those of Scene::load(). After an error it can be used as before.
class NEARLIGHT_API Animation {
  public:
    /// Reads the file as it is at frame 0. Throws Error: ErrorKind::file if its animations are broken;
    /// ErrorKind::invalid_argument if it has none, for an animation that is not there, for a number out of
    /// its range, or for `load.origin` without `load.target`, because the middle of the scene may move.
    Animation(const Devices& devices, const std::filesystem::path& file, const AnimationOptions& options = {},
              const LoadOptions& load = {}, const SessionOptions& session = {});
    ~Animation();
    Animation(Animation&&) noexcept;
    Animation& operator=(Animation&&) noexcept;

    /// The time of the first key, in seconds; frames before it show how the scene is then.
    [[nodiscard]] double begin() const;
    /// The time of the last key, in seconds; frames after it show how the scene is then.
    [[nodiscard]] double end() const;

    /// Renders a frame, from 0 to 999999. With RenderSettings::seconds its bits depend on the machine.
    Picture render(int frame, const RenderSettings& settings = {}, const Progress& progress = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight
