// SPDX-License-Identifier: Apache-2.0
// Irradiance of receivers by plain loops and Embree: what the gather kernels are checked with.
#pragma once

#include <span>
#include <vector>

#include "host/reference/embree_scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// E = Σ power/π · max0(cosθ_receiver)·max0(cosθ_vpl) / max(r², R²) · V for each receiver, V by the segment
/// from VPL to receiver, t in (1e-5, 1 − 1e-5). Terms in single precision, sums in double. Absent receivers
/// get 0.
/// @param clamp_radius R, m; 0: unbounded
/// @param threads 0: as many as there are cores; the result does not depend on it
/// Requires irradiance.size() == receivers.size().
void gather_reference(const EmbreeScene& embree, std::span<const Vpl> vpls, float clamp_radius,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads = 0);

/// Importons as the senders that a gather makes of them, for gather_reference().
std::vector<Vpl> as_vpls(std::span<const Importon> importons);

/// E = Σ intensity · max0(cosθ) / r² · V over point and spot lights; other lights in the span are left out.
void direct_reference(const EmbreeScene& embree, std::span<const Emitter> lights,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads = 0);

}  // namespace nearlight::core
