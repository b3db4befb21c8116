// SPDX-License-Identifier: Apache-2.0
// Lattice noise: smooth, deterministic, and the same on every machine with IEEE 754 arithmetic.
#pragma once

#include "host/base/math.h"

namespace nearlight::core::scenes {

/// Noise in [-1, 1] with one random value per point of a lattice of unit spacing, interpolated with zero
/// slope at the points.
float value_noise(Vec3 p);
/// Noise in about [-1, 1]: a sum of octaves, each with half the amplitude and twice the frequency of the one
/// before.
float fractal_noise(Vec3 p, int octaves);

}  // namespace nearlight::core::scenes
