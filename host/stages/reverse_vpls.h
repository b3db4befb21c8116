// SPDX-License-Identifier: Apache-2.0
// Reverse VPLs, which lie where rays from points that the camera sees land. The kernel is in reverse_vpls.cl.
#pragma once

#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {

/// The points that send the rays of reverse VPLs.
struct CameraPoints {
    Buffer<Importon> points;  ///< with the response rays_per_point, so that a gather sums the density of VPLs
    uint count = 0;
    uint rays_per_point = 1;
};

/// Makes camera points of `importons`. Each point is to send `rays_per_point` rays.
CameraPoints make_camera_points(Device& device, std::span<const Importon> importons, uint rays_per_point);

class ReverseVpls {
  public:
    /// Keeps a reference to `gatherer`, which must outlive the object.
    ReverseVpls(Device& device, Gatherer& gatherer);

    /// Makes a VPL wherever a ray lands on a surface that reflects. Its power is the albedo there, for an
    /// irradiance and a density of 1.
    std::vector<Vpl> trace(const DeviceScene& scene, const CameraPoints& points, uint seed);

    /// Writes the expected number of reverse VPLs per square metre around each receiver to all three channels
    /// of density.light. It is exact for these camera points and does not depend on the rays that they sent.
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
