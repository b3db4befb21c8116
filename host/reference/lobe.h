// SPDX-License-Identifier: Apache-2.0
// What the camera sees of a surface besides its Lambertian base.
#pragma once

#include "host/reference/sampling.h"
#include "host/reference/surface.h"

namespace nearlight::core {

struct LobeRandom {
    float choice = 0.0f;
    Point2 direction;
};

struct LobeSample {
    bool is_base = false;     ///< the Lambertian base was chosen; the path ends there
    Vec3 weight{0, 0, 0};     ///< of the light that arrives from `direction`, or that leaves the base
    Vec3 direction{0, 0, 0};  ///< unit, away from the surface
};

/// Chooses among the lobes of the surface as seen from the unit direction `to_viewer`. A zero weight ends the
/// path in black. Roughness is GGX's alpha, with Smith's separable masking; below 1e-3 it counts as smooth.
LobeSample sample_lobe(const Surface& surface, Vec3 to_viewer, LobeRandom random);

}  // namespace nearlight::core
