// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing over the whole scene.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight {

/// Which deposits are kept of those in the close range; the values are kernels/light_tracer.cl's.
enum class KeepDeposits : uint { all = 0, indirect_inside = 1, outside = 2 };

/// The part of the scene that close-range VPLs answer for.
struct CloseRegion {
    Buffer<CloseRange> range;
    Buffer<uint> triangles;       ///< 1 for each scene triangle that was selected
    bool whole_triangles = false;  ///< true: a selected triangle belongs to it whole (policy `paper`)
};

struct LightWalks {
    uint walk_count = 0;
    uint bounce_count = 1;  ///< most VPLs a walk deposits
    uint seed = 0;
};

class LightTracer {
  public:
    explicit LightTracer(Device& device);

    /// Fills walk_count · bounce_count slots of `vpls` and `flags` (1: holds a VPL to keep).
    /// `mean_albedo` in (0, 1) sets how many walks go on to each depth; any value is unbiased.
    void run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep, const LightWalks& walks,
             float mean_albedo, Buffer<Vpl>& vpls, Buffer<uint>& flags);

  private:
    Device* device_;
    Program program_;
    Kernel light_tracer_;
};

}  // namespace nearlight
