// SPDX-License-Identifier: Apache-2.0
// Closest hits of given rays by Embree, used in the fastest way it offers.
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
    /// Builds both trees, without robust edges, over the triangles `ids`. Throws Error:
    /// ErrorKind::out_of_memory or ErrorKind::failure.
    EmbreeRays(const Scene& scene, std::span<const uint> ids);
    ~EmbreeRays();

    /// Returns the time inside Embree's calls only (wall time is summed over threads and divided by their
    /// number); rays are laid out beforehand. Writes to `distances` the t of each closest hit, or infinity
    /// for a ray that hits nothing.
    Seconds trace(std::span<const RayQuery> rays, const EmbreeMode& mode, int threads,
                  std::vector<float>& distances) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
