// SPDX-License-Identifier: Apache-2.0
// Lights that the rays of single receivers find and that light all receivers of their bundle. The kernels are
// in shared_lights.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/receiver_paths.h"
#include "kernels/shared/shared_light.h"
#include "nearlight/settings.h"

namespace nearlight::core {

class SharedLights {
  public:
    /// Begins to compile the kernels. `kernel` is that of the gather.
    SharedLights(Device& device, GatherKernel kernel);

    /// Adds to the irradiance (W/m²) of each receiver that shares lights what those of its bundle bring: an
    /// unbiased estimate of what ReceiverPaths::run_sharing() left to `found` with the same settings. The
    /// tree of the scene must be uploaded for the gather kernel.
    void add(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
             const ReceiverPathSettings& settings, const Buffer<SharedLight>& found,
             Buffer<IrradiancePacket>& irradiance);

  private:
    void make_lists(std::size_t bundle_count);
    void find_seeing_receivers(const DeviceScene& scene, const Buffer<ReceiverPacket>& receivers,
                               std::size_t packet_count, const ReceiverPathSettings& settings,
                               const Buffer<SharedLight>& found);

    Device* device_;
    GatherKernel kernel_;  ///< never `automatic`
    Program program_;
    Kernel choose_;
    Kernel gather_;
    Kernel visibility_;
    // Lists of NEARLIGHT_SHARED_LIST entries for each bundle.
    Buffer<uint> listed_;       ///< the receivers that found the lights
    Buffer<float> factors_;     ///< of the lights' radiance
    Buffer<uint> lengths_;      ///< of the lists
    Buffer<uint> seen_by_;      ///< for each entry a bit for each receiver of the bundle
    Buffer<uint> next_bundle_;  ///< the queue of shared_light_packets: a single counter
    Buffer<float> no_curves_;
};

}  // namespace nearlight::core
