// SPDX-License-Identifier: Apache-2.0
// Rays cast on the device, for comparing its traversal with others. Kernels: ray_caster.cl.
#pragma once

#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {

class RayCaster {
  public:
    explicit RayCaster(Device& device);

    /// Enqueues: for each ray the closest hit.
    void cast(const DeviceTree& tree, const Buffer<RayQuery>& rays, Buffer<RayHit>& hits);
    /// For each ray the closest hit (triangle ~0u: none). Uploads the tree anew; waits for the device.
    std::vector<BvhHit> closest_hits(const Bvh& bvh, std::span<const RayQuery> rays);
    /// For each ray 1 if it hits anything, else 0.
    std::vector<uint> any_hits(const Bvh& bvh, std::span<const RayQuery> rays);

  private:
    Device* device_;
    Program program_;
    Kernel cast_closest_;
    Kernel cast_any_;
};

}  // namespace nearlight::core
