// SPDX-License-Identifier: Apache-2.0
// Lattice noise: smooth, deterministic, the same on every machine that rounds as IEEE 754 says.
#pragma once

#include "host/base/math.h"

namespace nearlight::core::scenes {

/// In [-1, 1], one random value a lattice point of unit spacing, interpolated with zero slope there.
float value_noise(Vec3 p);
/// Sum of octaves, each of half the amplitude and twice the frequency; about [-1, 1].
float fractal_noise(Vec3 p, int octaves);

}  // namespace nearlight::core::scenes
