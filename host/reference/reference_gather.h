// SPDX-License-Identifier: Apache-2.0
// Irradiance of receivers by plain loops and Embree: the oracle of the gather kernels.
#pragma once

#include <span>
#include <vector>

#include "host/reference/embree_scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Computes E = Σ power/π · max0(cosθ_receiver)·max0(cosθ_vpl) / max(r², R²) · V for each receiver; V is the
/// visibility of the segment from VPL to receiver, t in (1e-5, 1 − 1e-5), and 0 for VPLs that are seen from
/// behind their shading normal. Terms are in single precision, sums in double precision. Absent receivers get
/// 0.
/// @param clamp_radius R, m; 0: unbounded
/// @param threads 0: one per core; the result does not depend on it. Requires irradiance.size() ==
/// receivers.size().
void gather_reference(const EmbreeScene& embree, std::span<const Vpl> vpls, float clamp_radius,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads = 0);

/// The importons as senders in the form of VPLs, which gather_reference() takes.
std::vector<Vpl> as_vpls(std::span<const Importon> importons);

/// Sums the irradiance from the scene's delta lights, with visibility, for each receiver. Threads: 0 is one
/// per core.
void direct_reference(const EmbreeScene& embree, const Scene& scene,
                      std::span<const ReceiverPacket> receivers, std::span<IrradiancePacket> irradiance,
                      int threads = 0);

}  // namespace nearlight::core
