// SPDX-License-Identifier: Apache-2.0
// Light walks whose number follows from how many VPLs are wanted.
#pragma once

#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// A region without triangles: nothing is close.
CloseRegion empty_region(SamplerStages& stages, const DeviceScene& scene);

struct Deposits {
    std::vector<Vpl> vpls;
    uint walk_count = 0;  ///< that were launched
};

/// About `wanted` deposits. A small independent pilot measures how many a walk leaves, so that the number of
/// walks does not depend on the walks themselves: stopping at a number of deposits would be biased.
Deposits trace_about(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region,
                     KeepDeposits keep, uint wanted);

}  // namespace nearlight::core
