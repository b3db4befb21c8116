// SPDX-License-Identifier: Apache-2.0
// The options of `nearlight render` by which it makes the frames of an animation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/cli/command.h"
#include "host/scene/scene.h"
#include "nearlight/settings.h"

namespace nearlight::core {

struct FrameRange {
    int first = 0;
    int last = 0;  ///< is made too; not less than `first`
};

struct FrameOptions {
    std::optional<FrameRange> range{};  ///< empty: one picture of the scene at rest
    AnimationOptions animation{};
    bool skip_existing = false;
};

/// Adds --frames, --fps, --animation, --vpl-keys and --skip-existing. Options of checkpoints and VPL files
/// must have been added before.
void add_frame_options(CLI::App& command, FrameOptions& options);

/// Parses "10:20", both ends included, or "10", which is a single frame. Throws
/// Error(ErrorKind::invalid_argument) unless both are from 0 to 999999 and ascend.
FrameRange parse_frames(const std::string& text);

/// The file of a frame. Its number, with zeros before it, takes the place of the last run of # in the name,
/// or else stands before the extension with four digits or more.
std::string numbered(const std::string& file, int frame);

/// The files of a frame.
std::vector<std::string> numbered(const std::vector<std::string>& files, int frame);

/// The frames to make. If the options say so, frames that have all their files are left out.
std::vector<int> frames_to_make(const FrameOptions& options, const std::vector<std::string>& outputs);

/// Warns of frames before and after the animation, which show its begin and end.
void tell_range(const FrameOptions& options, const Scene& scene);

}  // namespace nearlight::core
