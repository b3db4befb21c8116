// SPDX-License-Identifier: Apache-2.0
// The table of all lights.
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Whether the light is a triangle, sphere or cylinder.
bool is_area_light(const Emitter& emitter);
/// Whether the light is the environment's map or its sun.
bool is_distant(const Emitter& emitter);
/// Whether the light shines from a single point or in a single direction, so that no path can hit it.
bool is_delta_light(const Emitter& emitter);

struct EmitterTable {
    /// Directional lights, other delta lights, area lights, the sun, the environment; cdf ends at exactly 1.
    std::vector<Emitter> emitters;
    /// Over the entries of `emitters` from tree_first on and before tree_end (light_tree.h); if these are
    /// equal, there is no tree.
    std::vector<LightNode> light_tree;
    uint tree_first = 0, tree_end = 0;
    uint delta_emitter_count = 0;
    float total_power = 0.0f;  ///< luminance of all emitted flux, W
};
/// Makes the table of all lights. Each kind of light that there is (lamps without and with a surface,
/// directional lights, the sun, the sky) gets the same part of the probability, in proportion to the
/// luminance of emitted power within the kind. Power is π·area·radiance of an area light, 4π·intensity of a
/// point, the intensity of a spot integrated over its falloff, that of a projector over its image, and all
/// light that enters the sphere around the scene, πR²·∫ L dω of the environment or its sun and πR²·E of a
/// directional light. Images count by their mean. Lights without power are left out; the table is empty if
/// nothing emits. `probability` is exactly the step of `cdf` (distribution.h).
EmitterTable build_emitter_table(const Scene& scene);

}  // namespace nearlight::core
