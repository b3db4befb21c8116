// SPDX-License-Identifier: Apache-2.0
// Embree on the very segments that a gather traces, as fast as Embree goes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight {

/// One way to ask Embree.
struct EmbreeMode {
    int width = 16;             ///< rays a call: 1 or 16
    bool coherent = false;      ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT
    bool high_quality = false;  ///< RTC_BUILD_QUALITY_HIGH (spatial splits) instead of MEDIUM
};
std::string to_string(const EmbreeMode& mode);

/// (receiver, VPL) pairs, of which some are rays. The spans must outlive their user.
struct OcclusionWork {
    std::span<const Vpl> vpls;
    std::span<const ReceiverPacket> receivers;
    /// Entry (packet·vpl_count + vpl)·64 + lane is not 0 where the pair is a ray.
    std::span<const std::uint8_t> is_ray;
};

struct OcclusionResult {
    double seconds = 0.0;  ///< inside Embree's calls only, summed over threads and divided by their number
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
    std::vector<std::uint8_t> occluded_pairs;  ///< if asked for: 1 where a ray is occluded, indexed as is_ray
};

class EmbreeOcclusion {
  public:
    /// Builds both trees, without robust edges, over the triangles `ids`. Throws Error(ExitCode::runtime).
    EmbreeOcclusion(const Scene& scene, std::span<const uint> ids);
    ~EmbreeOcclusion();
    EmbreeOcclusion(EmbreeOcclusion&&) noexcept;
    EmbreeOcclusion& operator=(EmbreeOcclusion&&) noexcept;

    /// Traces every ray of the work, VPL to receiver, packet by packet and VPL by VPL as the gather does.
    /// Rays are laid out in full groups of 16 beforehand, block by block in the cache, and that is not timed.
    [[nodiscard]] OcclusionResult trace(const OcclusionWork& work, const EmbreeMode& mode, int threads,
                                        bool keep_pairs = false) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight
