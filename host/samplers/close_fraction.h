// SPDX-License-Identifier: Apache-2.0
// How to split the budget between close-range patches and light walks.
#pragma once

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// Share of the VPLs that patches should have, from a pilot set of light walks: each side gets VPLs in
/// proportion to the root of the sum of squares of what its VPLs bring to the camera, which is what minimises
/// the variance of the sum (Neyman allocation). Within [0.1, 0.9]; 0 where the pilot finds no light in the
/// close range.
float choose_close_fraction(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region);

}  // namespace nearlight::core
