// SPDX-License-Identifier: Apache-2.0
// Sparse quasi-random light tracing over the whole scene.
#pragma once

#include <functional>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/prefix_scan.h"
#include "kernels/shared/light_tracer.h"
#include "kernels/shared/walk_aim.h"

namespace nearlight::core {

/// Which deposits in the close range are kept.
enum class KeepDeposits : uint {
    all = NEARLIGHT_KEEP_ALL,
    indirect_inside = NEARLIGHT_KEEP_INDIRECT_INSIDE,
    outside = NEARLIGHT_KEEP_OUTSIDE,
};

/// The part of the scene whose light close-range VPLs carry.
struct CloseRegion {
    Buffer<CloseRange> range;
    Buffer<uint> triangles;        ///< one per scene triangle: 1 if it was selected, else 0
    bool whole_triangles = false;  ///< whether selected triangles lie in it as a whole (policy `paper`)
};

/// Bounds of the part of the walks that go on from a surface, or to the next depth. They keep deep light from
/// costing as much as all other light in bright rooms, and from having hardly any walks in dark rooms.
inline constexpr float kMinSurvival = 0.2f;
inline constexpr float kMaxSurvival = 0.95f;

/// How walks are launched. The result is unbiased for any aim and any survival above 0.
struct LightWalks {
    uint walk_count = 0;
    uint bounce_count = 1;  ///< maximum number of VPLs that a walk deposits
    /// Bounds, in (0, 1], of the part of the walks that a surface sends on, which otherwise follows what it
    /// reflects.
    float min_survival = kMinSurvival;
    float max_survival = kMaxSurvival;
    uint seed = 0;
    WalkAim aim{};  ///< of walks from far away
};

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
    Kernel collect_;
    PrefixScan<uint> scan_;
};

}  // namespace nearlight::core
