// SPDX-License-Identifier: Apache-2.0
// Renders the frames of an animation.
#pragma once

#include "host/cli/render_run.h"

namespace nearlight::core {

/// Renders the frames that `options.frames` names, one after another. Where only the camera moves, scene,
/// trees and VPLs stay on the devices. What a frame looks like does not depend on which others are made.
ExitCode render_frames(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice);

}  // namespace nearlight::core
