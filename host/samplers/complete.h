// SPDX-License-Identifier: Apache-2.0
// The policy `complete` of close-range sampling.
#pragma once

#include "host/samplers/close_surface.h"

namespace nearlight::core {

/// VPLs in the close range carry light of all depths, those elsewhere are deposits of light walks, and both
/// are chosen from many candidates by what they bring to the camera. `surface` must be all of the close
/// range, the unlit parts included.
VplSet sample_complete(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface);

}  // namespace nearlight::core
