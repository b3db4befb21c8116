// SPDX-License-Identifier: Apache-2.0
// How a finished picture is divided into passes.
#pragma once

#include "nearlight/settings.h"
#include "viewer/refinement.h"

namespace nearlight::viewer {

/// Pixels of a square of this side ask different VPLs.
inline constexpr int kInterleave = 4;
/// The light samples of a finished pixel, unless the settings say how many: the pilot that chooses them for
/// `nearlight render` would take too long for each change of the camera.
inline constexpr std::uint32_t kDefaultDirectSamples = 32;

/// The settings of the gather of one step. `whole` is what a finished picture has: its passes have one sample
/// per pixel each and share rays and light samples, so that `samples_per_pixel` passes cost and bring what a
/// render with these settings does. A small or a first picture has as little as possible.
GatherSettings pass_gather(const RenderSettings& whole, StepKind kind);

/// The settings of the view of one step: its size is divided by the divisor, and no pilot takes time.
ViewSettings pass_view(const ViewSettings& whole, int width, int height, int divisor);

/// The seed of a step. Each pass has random numbers of its own; small and first pictures all have the same,
/// so that their noise stands still.
std::uint32_t pass_seed(std::uint32_t seed, const Step& step);

/// Whether a step is to make new VPLs, so that the noise of VPLs averages out too.
bool makes_vpls(const Step& step);

}  // namespace nearlight::viewer
