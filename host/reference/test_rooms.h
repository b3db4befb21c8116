// SPDX-License-Identifier: Apache-2.0
// Rooms whose light is known.
#pragma once

#include "host/base/math.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Full of rough spheres, closed, with a lamp and of one albedo: no light is lost but what the albedo takes.
Scene make_even_room(Vec3 albedo);

/// The same shape in its own colours, without its lamp, under point and spot lights.
Scene make_delta_lit_room();

/// The inside of a sphere about a point light (1 W/sr): its irradiance is 1 / radius² everywhere, but for the
/// 2 ‰ that flat triangles take.
Scene make_lit_sphere(float radius, float albedo);

}  // namespace nearlight::core
