// SPDX-License-Identifier: Apache-2.0
// Light walks whose number follows from the wanted number of VPLs.
#pragma once

#include <vector>

#include "host/samplers/sampler.h"

namespace nearlight::core {

/// The maximum number of walks for a set of VPLs. It bounds the time if hardly any walk leaves one.
inline constexpr double kMaxWalks = 1 << 22;

/// Makes a close region without triangles, so that no deposit is close.
CloseRegion empty_region(SamplerStages& stages, const DeviceScene& scene);

/// The sphere at which walks aim: around the camera, as far as the close range reaches.
WalkAim walk_aim(const SamplingTask& task);

struct Deposits {
    std::vector<Vpl> vpls;
    uint walk_count = 0;  ///< number of walks that were launched
    /// The number of close deposits to expect by the pilot, which `vpls` is not part of.
    double expected_close = 0;
};

/// Traces about `wanted` deposits. A small independent pilot measures how many deposits a walk leaves, so
/// that the number of walks does not depend on the walks themselves; to stop at a number of deposits would
/// bring bias.
Deposits trace_about(SamplerStages& stages, const SamplingTask& task, const CloseRegion& region,
                     KeepDeposits keep, uint wanted);

}  // namespace nearlight::core
