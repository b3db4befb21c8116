// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing over the whole scene.
#pragma once

#include <functional>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

/// Which deposits in the close range are kept. The values must be those in kernels/light_tracer.cl.
enum class KeepDeposits : uint { all = 0, indirect_inside = 1, outside = 2 };

/// The part of the scene whose light close-range VPLs carry.
struct CloseRegion {
    Buffer<CloseRange> range;
    Buffer<uint> triangles;        ///< one per scene triangle: 1 if it was selected, else 0
    bool whole_triangles = false;  ///< whether selected triangles lie in it as a whole (policy `paper`)
};

/// How walks are launched. The result is unbiased for any `survival` above 0 and any aim.
struct LightWalks {
    uint walk_count = 0;
    uint bounce_count = 1;  ///< maximum number of VPLs that a walk deposits
    float survival = 0.5f;  ///< of the walks that go on to a depth, the part that goes on to the next
    uint seed = 0;
    WalkAim aim{};  ///< of walks from infinitely far away
};

/// A survival within the bounds that walks have. They keep deep light from costing as much as all other light
/// in bright rooms, and from having hardly any walks in dark rooms.
float bounded_survival(float survival);
/// How many walks, a real number, go on to each depth from 1 to bounce_count.
std::vector<float> walks_at_each_depth(const LightWalks& walks);

/// Takes deposits while they are on the device: the first `count` ≥ 1 elements of `vpls`, which the next
/// batch overwrites.
using DepositVisitor = std::function<void(const Buffer<Vpl>& vpls, std::size_t count)>;

class LightTracer {
  public:
    explicit LightTracer(Device& device);

    /// Returns all deposits that `keep` keeps, in the order of walks and depths. Works in batches to use
    /// little device memory.
    std::vector<Vpl> run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep,
                         const LightWalks& walks);
    /// Passes the deposits that `keep` keeps to `visit`, batch by batch, for work that does not need all of
    /// them at once.
    void run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep, const LightWalks& walks,
             const DepositVisitor& visit);

  private:
    Device* device_;
    Program program_;
    Kernel light_tracer_;
    Compaction compaction_;
};

}  // namespace nearlight::core
