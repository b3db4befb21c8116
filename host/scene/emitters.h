// SPDX-License-Identifier: Apache-2.0
// The flat table of lights, and the tables by which an environment is importance sampled.
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

struct EmitterTable {
    std::vector<Emitter>
        emitters;  ///< delta lights, emissive triangles, the environment; cdf ends at exactly 1
    uint delta_emitter_count = 0;
    float total_power = 0.0f;  ///< luminance of all emitted flux, W
};
/// Probabilities are in proportion to the luminance of emitted power: π·area·radiance of a triangle, 4π·
/// intensity of a point, the intensity of a spot integrated over its falloff, and of the environment all that
/// enters the sphere around the scene, πR²·∫ L dω. Lights without power are left out; empty where nothing
/// emits. `probability` is exactly the step of `cdf`, see distribution.h.
EmitterTable build_emitter_table(const Scene& scene);

struct EnvironmentTable {
    Environment parameters{};
    std::vector<float> pixels;  ///< RGBA radiance, 4·width·height; a single zero pixel where there is none
    /// Piecewise constant in (column, row) cells of equal angle, in proportion to luminance · sinθ of the
    /// cell's centre, the exact share of a pixel. Made and used as distribution.h says. Density over solid
    /// angle in cell (i, j): row_step·column_step·width·height / (2π²·sinθ), θ that of the direction:
    /// cumulative distribution of the rows (height entries, the last is 1), then of each row's columns.
    std::vector<float> row_cdf;
    std::vector<float> column_cdf;  ///< width·height
};
EnvironmentTable build_environment_table(const Scene& scene);

}  // namespace nearlight::core
