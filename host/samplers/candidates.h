// SPDX-License-Identifier: Apache-2.0
// What samplers that choose VPLs out of many candidates want to know about them.
#pragma once

#include <span>
#include <vector>

#include "host/samplers/resampling.h"
#include "host/samplers/sampler.h"

namespace nearlight {

/// At most task.vpl_count + 1 candidates, in proportion to what they bring to the camera; a small part
/// follows power alone, so that a candidate is chosen now and then even where the sample of the view does not
/// see it. To be put in an order in which neighbours are alike.
/// @param stream sets the random number apart from those of other uses of the seed.
Choice choose_by_contribution(SamplerStages& stages, const SamplingTask& task,
                              std::span<const Vpl> candidates, uint stream);

}  // namespace nearlight
