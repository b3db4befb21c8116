// SPDX-License-Identifier: Apache-2.0
// Which of Mitsuba's shapes are sampled as one light.
#pragma once

#include <optional>
#include <string>

#include "host/scene/scene.h"

namespace nearlight::core::mitsuba {

/// Whether the transform leaves a sphere round.
bool is_round_sphere(const Mat4& to_world);

/// The transform that Mitsuba has for a sphere instead of one that would stretch it: the radius is that along
/// the x axis. The transform must have an inverse.
Mat4 rounded_sphere(const Mat4& to_world);

/// The light that a shape of this type is if it shines evenly and outwards: a sphere or cylinder that its
/// placement leaves round. `to_world` places the mesh of shape_mesh.h, whose triangles are those of the scene
/// from first_triangle on.
std::optional<RoundLamp> round_lamp(const Scene& scene, const std::string& type, const Mat4& to_world,
                                    std::size_t first_triangle);

}  // namespace nearlight::core::mitsuba
