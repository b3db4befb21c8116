// SPDX-License-Identifier: Apache-2.0
// The lobes of a surface besides its Lambertian base, which only the camera sees.
#pragma once

#include "host/reference/sampling.h"
#include "host/reference/surface.h"

namespace nearlight::core {

/// Uniform random numbers in [0, 1) for the choice of a lobe and of a direction in it.
struct LobeRandom {
    float choice = 0.0f;
    Point2 direction;
};

struct LobeSample {
    bool is_base = false;     ///< the Lambertian base was chosen; the path ends there
    Vec3 weight{0, 0, 0};     ///< weight of the light from `direction`, or of the light that leaves the base
    Vec3 direction{0, 0, 0};  ///< unit vector, away from the surface
};

/// Chooses among the lobes of the surface as seen from the unit direction `to_viewer`. A weight of zero ends
/// the path in black. Roughness is GGX's alpha, with Smith's separable masking; an alpha below 1e-3 counts as
/// smooth.
LobeSample sample_lobe(const Surface& surface, Vec3 to_viewer, LobeRandom random);

}  // namespace nearlight::core
