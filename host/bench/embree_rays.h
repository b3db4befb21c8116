// SPDX-License-Identifier: Apache-2.0
// Embree on given rays, for their closest hits, as fast as Embree goes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/bench/embree_modes.h"
#include "host/bench/seconds.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

class EmbreeRays {
  public:
    /// Builds both trees, without robust edges, over the triangles `ids`. Throws Error: out_of_memory, or
    /// runtime.
    EmbreeRays(const Scene& scene, std::span<const uint> ids);
    ~EmbreeRays();

    /// Time inside Embree's calls only (wall: summed over threads and divided by their number); rays are laid
    /// out beforehand. Writes to `distances` the t of each closest hit, infinity where there is none.
    Seconds trace(std::span<const RayQuery> rays, const EmbreeMode& mode, int threads,
                  std::vector<float>& distances) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
