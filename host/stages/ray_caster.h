// SPDX-License-Identifier: Apache-2.0
// Casts rays that the host chose, for openings, for what lights a point, and to compare the traversal with
// others. The kernels are in ray_caster.cl.
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

    /// Writes the closest hit of each ray to `hits`. Does not wait for the device.
    void cast(const DeviceTree& tree, const Buffer<RayQuery>& rays, Buffer<RayHit>& hits);
    /// Returns the closest hit of each ray; the triangle is ~0u if the ray hits nothing. Uploads the tree and
    /// waits for the device.
    std::vector<BvhHit> closest_hits(const Bvh& bvh, std::span<const RayQuery> rays);
    /// Returns 1 for each ray that hits anything, 0 for the others. Uploads the tree and waits for the
    /// device.
    std::vector<uint> any_hits(const Bvh& bvh, std::span<const RayQuery> rays);
    /// Does as any_hits() with a tree that is on the device.
    std::vector<uint> occluded(const DeviceTree& tree, std::span<const RayQuery> rays);

  private:
    Device* device_;
    Program program_;
    Kernel cast_closest_;
    Kernel cast_any_;
};

}  // namespace nearlight::core
