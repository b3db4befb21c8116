// SPDX-License-Identifier: Apache-2.0
// The policy `complete` of close-range sampling.
#pragma once

#include "host/samplers/close_surface.h"

namespace nearlight::core {

/// Candidates are patches of the close range, which carry light of all depths, and deposits of light walks
/// everywhere; the two share the light of the close range. VPLs are drawn from them by what they bring to the
/// camera. `surface` must be all of the close range, the unlit parts included.
VplSet sample_complete(SamplerStages& stages, const SamplingTask& task, CloseSurface& surface);

}  // namespace nearlight::core
