// SPDX-License-Identifier: Apache-2.0
// Mitsuba's sensors with their film and sampler.
#pragma once

#include "host/scene/mitsuba/object.h"

namespace nearlight::core::mitsuba {

/// Sets the camera, the picture's size and the samples per pixel of the scene.
void apply_sensor(const Object& sensor, Scene& scene, NoteSink& notes);

/// The horizontal field of view, in degrees, that a sensor or projector has by `fov` and `fov_axis` or by
/// `focal_length`; aspect = width ÷ height.
double read_fov(const Object& owner, double aspect);
/// The horizontal field of view, in degrees, of one along `axis` (x, y, diagonal, smaller, larger); aspect =
/// width ÷ height. Calls fail() for another axis.
double horizontal_fov(double fov_degrees, const std::string& axis, double aspect, const Location& where);

}  // namespace nearlight::core::mitsuba
