// SPDX-License-Identifier: Apache-2.0
// How glTF materials let light through.
#pragma once

#include <cmath>

#include "host/scene/gltf/surface_model.h"

namespace nearlight::core::gltf {

/// The inside of a body, by KHR_materials_volume. It absorbs light only where the surface transmits some.
struct Volume {
    double thickness = 0;        ///< in the coordinates of the mesh; 0 or less: the surface is a thin pane
    double distance = HUGE_VAL;  ///< in the world, after which `color` is left of white light
    Vec3 color{1, 1, 1};         ///< in [0, 1]

    [[nodiscard]] bool is_thin() const { return thickness <= 0; }
    [[nodiscard]] bool absorbs() const {
        return !is_thin() && distance > 0 && std::isfinite(distance) && !(color == Vec3{1, 1, 1});
    }
};
Volume volume_of(const tinygltf::Material& source);
/// Whether bodies of the material absorb light, more of it the larger they are.
bool absorbs_inside(const tinygltf::Material& source);

/// Reads what light of a surface goes through, and what its inside absorbs.
void read_transmission(const tinygltf::Material& source, const SurfaceContext& context,
                       SurfaceModel& surface);

}  // namespace nearlight::core::gltf
