// SPDX-License-Identifier: Apache-2.0
// Embree's trees: how long they take to build, and the trees themselves in our layout.
#pragma once

#include <span>

#include "host/bench/seconds.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

enum class EmbreeQuality {
    medium,  ///< RTC_BUILD_QUALITY_MEDIUM: binned surface area heuristic
    high,    ///< RTC_BUILD_QUALITY_HIGH: with spatial splits
};

/// Seconds that rtcCommitScene() takes for the triangles `ids`, with Embree's own kind of tree. Throws
/// Error(ErrorKind::failure) where Embree fails.
Seconds seconds_of_embree_build(const Scene& scene, std::span<const uint> ids, EmbreeQuality quality);

/// Builds a binary tree by rtcBuildBVH(), with the same costs and leaf size as ours and, at high quality,
/// room for as many cut triangles as Embree's own scenes have by default (20 %). It has our layout except for
/// the order of nodes. Throws Error(ErrorKind::failure) where Embree fails.
Bvh build_embree_bvh(const Scene& scene, std::span<const uint> ids, EmbreeQuality quality,
                     const BvhConfig& config = {});

}  // namespace nearlight::core
