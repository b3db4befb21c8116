// SPDX-License-Identifier: Apache-2.0
// What Mitsuba's integrators say about the picture: how long its paths are, and whether emitters are seen.
#pragma once

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Sets the scene's maximum depth and whether emitters are hidden. Notes properties of known integrators that
/// mean nothing here, unless they only say how the picture is computed. Calls fail() for an integrator whose
/// picture is not one of all light along paths of a limited length.
void apply_integrator(const Object& integrator, Scene& scene, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
