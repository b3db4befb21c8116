// SPDX-License-Identifier: Apache-2.0
// Embree on the segments that a gather traces, used in the fastest way it offers.
#pragma once

#include <memory>

#include "host/bench/embree_modes.h"
#include "host/bench/gather_segments.h"
#include "host/bench/seconds.h"

namespace nearlight::core {

struct OcclusionResult {
    Seconds seconds;  ///< inside Embree's calls only; wall time is summed over threads and divided by their
                      ///< number
    std::uint64_t rays = 0;
    PairMask occluded;  ///< empty unless `keep_answers` was set
};

class EmbreeOcclusion {
  public:
    /// Builds both trees, without robust edges, over all triangles. Throws Error: ErrorKind::out_of_memory or
    /// ErrorKind::failure.
    explicit EmbreeOcclusion(const Scene& geometry);
    ~EmbreeOcclusion();
    EmbreeOcclusion(EmbreeOcclusion&&) noexcept;
    EmbreeOcclusion& operator=(EmbreeOcclusion&&) noexcept;

    /// Traces every segment from VPL to receiver, packet by packet and VPL by VPL as the gather does. The
    /// rays of a packet are laid out in full sets of 16 beforehand, so few at a time that they stay in the
    /// cache; this is not timed.
    [[nodiscard]] OcclusionResult trace(const GatherSegments& segments, const EmbreeMode& mode, int threads,
                                        bool keep_answers = false) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
