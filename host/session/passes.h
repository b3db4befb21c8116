// SPDX-License-Identifier: Apache-2.0
// Several renderings of one view, which differ only in their random numbers and their numbers of samples.
#pragma once

#include <span>

#include "kernels/shared/types.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// Whether a picture has several passes, or ends by time or error.
bool may_have_passes(const RenderSettings& settings);

/// Whether the samples per pixel of these passes say anything about the picture's error. A single sample does
/// not.
bool tells_error(std::span<const uint> samples);

/// The seed of a pass of a picture with the seed `seed`. Pass 0 has `seed` itself; the others mix it with
/// `pass`, so that pictures of neighbouring seeds share no pass.
uint pass_seed(uint seed, uint pass);

/// The fewest samples per pixel that the first pass may have: 2, because a single sample says nothing about
/// its error, or 1 if the settings ask for one.
uint min_pass_samples(const GatherSettings& settings);

/// The fewest samples per pixel that a pass after the first may have: as many as splats need, if the picture
/// has splats. Samples that count in their own pixel alone are noisier, but would weigh as much.
uint min_later_samples(const GatherSettings& settings);

/// The settings of a pass of `samples` per pixel, which may be more or fewer than the settings say. All that
/// a pixel gets changes in proportion: VPLs, their strata, light samples and rays; so each sample stays what
/// it was.
RenderSettings with_samples(RenderSettings settings, uint samples);

}  // namespace nearlight::core
