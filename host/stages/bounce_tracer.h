// SPDX-License-Identifier: Apache-2.0
// Indirect light of receivers by path tracing: all of it, or what a bounded gather leaves out.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"

namespace nearlight::core {

struct BouncePaths {
    uint sample_count = 1;  ///< paths a receiver
    uint bounce_count = 1;  ///< most reflections between light and receiver
    float clamp_radius =
        0.0f;  ///< m; what lies farther is left out, what is nearer weighs 1 − r²/R²; may be infinite
    uint seed = 0;
};

class BounceTracer {
  public:
    explicit BounceTracer(Device& device);

    /// Adds to `irradiance`, W/m².
    void run(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             const BouncePaths& paths, Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel bounce_tracer_;
};

}  // namespace nearlight::core
