// SPDX-License-Identifier: Apache-2.0
// All the light that arrives at receivers, from VPLs and by short paths. Kernel: path_light.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight {

/// VPLs that light receivers, of all depths, in an order in which neighbours are alike.
struct SparseVpls {
    Buffer<Vpl> vpls;
    std::size_t count = 0;
    float radius = 0.0f;  ///< of the bounded geometry term, m; paths supply what it takes away
};

struct LightPaths {
    uint path_count = 1;      ///< a receiver
    uint bounce_count = 1;    ///< most steps from a light to the receiver; 1 is direct light only
    uint connections = 1;     ///< of a path's vertex, to VPLs chosen evenly among them
    uint direct_samples = 1;  ///< of a path, towards area and environment lights, at the receiver itself
    uint seed = 0;
};

class PathLight {
  public:
    explicit PathLight(Device& device);

    /// Irradiance without bias, W/m².
    void run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             const SparseVpls& sparse, const LightPaths& paths, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel path_light_;
};

}  // namespace nearlight
