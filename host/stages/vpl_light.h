// SPDX-License-Identifier: Apache-2.0
// VPLs as receivers of light, and the light that they reflect.
#pragma once

#include "host/base/receivers.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Whether VPLs are wanted as receivers of light, with the shading normals of their surfaces, or as places
/// that send light out, with geometric normals. The two differ where a mesh has shading normals.
enum class VplSide { receives, emits };

class VplLight {
  public:
    explicit VplLight(Device& device);

    /// Writes VPL i as the receiver in lane i % 64 of packet i / 64. There are
    /// receiver_packet_count(vpl_count) packets.
    void make_receivers(const Buffer<Vpl>& vpls, std::size_t vpl_count, VplSide side,
                        Buffer<ReceiverPacket>& receivers);
    /// Multiplies the power of each VPL by the irradiance of its lane.
    void apply(const Buffer<IrradiancePacket>& irradiance, std::size_t vpl_count, Buffer<Vpl>& vpls);
    /// Adds `more` to `irradiance`, receiver by receiver.
    void add(const Buffer<IrradiancePacket>& more, std::size_t packet_count,
             Buffer<IrradiancePacket>& irradiance);

  private:
    Program program_;
    Kernel vpl_receivers_;
    Kernel vpl_light_;
    Kernel add_irradiance_;
};

}  // namespace nearlight::core
