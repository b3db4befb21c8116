// SPDX-License-Identifier: Apache-2.0
// Embree on given rays, for their closest hits, as fast as Embree goes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/bench/seconds.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight {

/// One way to ask.
struct EmbreeRayMode {
    int width = 16;             ///< rays a call: 1 or 16
    bool coherent = false;      ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT
    bool high_quality = false;  ///< RTC_BUILD_QUALITY_HIGH instead of MEDIUM
};
std::string to_string(const EmbreeRayMode& mode);
std::vector<EmbreeRayMode> all_embree_ray_modes();

class EmbreeRays {
  public:
    /// Builds both trees, without robust edges, over the triangles `ids`. Throws Error: out_of_memory, or
    /// runtime.
    EmbreeRays(const Scene& scene, std::span<const uint> ids);
    ~EmbreeRays();

    /// Time inside Embree's calls only (wall: summed over threads and divided by their number); rays are laid
    /// out beforehand. Writes to `distances` the t of each closest hit, infinity where there is none.
    Seconds trace(std::span<const RayQuery> rays, const EmbreeRayMode& mode, int threads,
                  std::vector<float>& distances) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight
