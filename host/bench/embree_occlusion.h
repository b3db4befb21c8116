// SPDX-License-Identifier: Apache-2.0
// Embree on the very segments that a gather traces, as fast as Embree goes.
#pragma once

#include <memory>

#include "host/bench/embree_modes.h"
#include "host/bench/gather_segments.h"
#include "host/bench/seconds.h"

namespace nearlight::core {

struct OcclusionResult {
    Seconds seconds;  ///< inside Embree's calls only; wall: summed over threads and divided by their number
    std::uint64_t rays = 0;
    PairMask occluded;  ///< if asked for
};

class EmbreeOcclusion {
  public:
    /// Builds both trees, without robust edges, over all triangles. Throws Error: out_of_memory, or runtime.
    explicit EmbreeOcclusion(const Scene& geometry);
    ~EmbreeOcclusion();
    EmbreeOcclusion(EmbreeOcclusion&&) noexcept;
    EmbreeOcclusion& operator=(EmbreeOcclusion&&) noexcept;

    /// Traces every segment, VPL to receiver, packet by packet and VPL by VPL as the gather does. Rays are
    /// laid out in full groups of 16 beforehand, block by block in the cache, and that is not timed.
    [[nodiscard]] OcclusionResult trace(const GatherSegments& segments, const EmbreeMode& mode, int threads,
                                        bool keep_answers = false) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
