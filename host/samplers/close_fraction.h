// SPDX-License-Identifier: Apache-2.0
// Splits the budget of VPLs between close-range patches and light walks.
#pragma once

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// Which deposits of light walks the policies `paper` and `partition` keep beside the patches.
KeepDeposits deposits_to_keep(Policy policy);

/// How many of `vpl_count` VPLs are close ones if these have the share `close_fraction`, 0 to 1.
uint close_vpl_count(float close_fraction, uint vpl_count);

/// Chooses the share of the VPLs that patches should have, by a pilot set of light walks. Each side gets VPLs
/// in proportion to the root of the sum of squares of what its VPLs bring to the camera, which minimises the
/// variance of the sum (Neyman allocation). The share is in [0.1, 0.9]; it is 0.1 if the pilot finds no light
/// in the close range.
float choose_close_fraction(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region);

}  // namespace nearlight::core
