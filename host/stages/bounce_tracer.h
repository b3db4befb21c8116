// SPDX-License-Identifier: Apache-2.0
// Indirect light of receivers by path tracing: all of it, or what a bounded gather leaves out.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

struct BouncePaths {
    uint sample_count = 1;  ///< paths per receiver
    uint bounce_count = 1;  ///< maximum number of reflections between light and receiver
    /// The clamp radius R of the gather whose missing light the paths supply, in metres. Light from a
    /// distance r below R has the weight 1 − r²/R², and light from beyond R is left out. Infinity keeps all
    /// light.
    float clamp_radius = 0.0f;
    uint seed = 0;
};

class BounceTracer {
  public:
    explicit BounceTracer(Device& device);

    /// Adds the indirect light of each receiver to `irradiance`, in W/m².
    void run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             const BouncePaths& paths, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel bounce_tracer_;
};

}  // namespace nearlight::core
