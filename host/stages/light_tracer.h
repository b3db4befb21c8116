// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing over the whole scene.
#pragma once

#include <functional>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// Which deposits are kept of those in the close range; the values are kernels/light_tracer.cl's.
enum class KeepDeposits : uint { all = 0, indirect_inside = 1, outside = 2 };

/// The part of the scene that close-range VPLs answer for.
struct CloseRegion {
    Buffer<CloseRange> range;
    Buffer<uint> triangles;        ///< 1 for each scene triangle that was selected
    bool whole_triangles = false;  ///< true: a selected triangle belongs to it whole (policy `paper`)
};

/// How walks are launched. Any value of `mean_albedo` is unbiased.
struct LightWalks {
    uint walk_count = 0;
    uint bounce_count = 1;     ///< most VPLs a walk deposits
    float mean_albedo = 0.5f;  ///< sets how many walks go on to each depth
    uint seed = 0;
};

/// Takes deposits while they are on the device: the first `count` ≥ 1 of `vpls`, which is used again
/// afterwards.
using DepositVisitor = std::function<void(const Buffer<Vpl>& vpls, std::size_t count)>;

class LightTracer {
  public:
    explicit LightTracer(Device& device);

    /// All deposits to keep, in the order of walks and depths. Works in batches, so that device memory stays
    /// small.
    std::vector<Vpl> run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep,
                         const LightWalks& walks);
    /// The same deposits, batch by batch, for what need not be held all at once.
    void run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep, const LightWalks& walks,
             const DepositVisitor& visit);

  private:
    Device* device_;
    Program program_;
    Kernel light_tracer_;
    Compaction compaction_;
};

}  // namespace nearlight::core
