// SPDX-License-Identifier: Apache-2.0
// VPLs where rays from points that the camera sees land. Kernel: reverse_vpls.cl.
#pragma once

#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {

/// Where reverse VPLs are made from.
struct CameraPoints {
    Buffer<Importon> points;  ///< of response rays_per_point, so that a gather sums their density
    uint count = 0;
    uint rays_per_point = 1;
};

/// The surfaces' points that `importons` stand on, each to send so many rays.
CameraPoints make_camera_points(Device& device, std::span<const Importon> importons, uint rays_per_point);

class ReverseVpls {
  public:
    /// Gathers with `gatherer`, which must outlive it.
    ReverseVpls(Device& device, Gatherer& gatherer);

    /// A VPL where each ray lands on a surface that reflects; its power is the albedo there, for an
    /// irradiance and a density of 1.
    std::vector<Vpl> trace(const DeviceScene& scene, const CameraPoints& points, uint seed);

    /// How many of those VPLs there are a square metre around each receiver, in expectation: all three
    /// channels of density.light. Exact for these very points, whatever rays they sent.
    void measure_density(const DeviceScene& scene, const CameraPoints& points,
                         const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                         GatherSums<Importon>& density);

  private:
    Device* device_;
    Gatherer* gatherer_;
    Program program_;
    Kernel reverse_vpls_;
    Compaction compaction_;
};

}  // namespace nearlight::core
