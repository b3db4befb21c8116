// SPDX-License-Identifier: Apache-2.0
// Two numbers of a material that are looked up at once.
#pragma once

#include <optional>

#include "host/scene/scene.h"

namespace nearlight::core {

/// A parameter that has the number of `u` in x and that of `v` in y, for models with a roughness along each
/// axis. Textures and images are added to the scene where both numbers need one. Nothing is returned if their
/// textures cannot be looked up as one: they lie differently on the surface, their bitmaps differ in size,
/// wrapping or filter, or one is a bitmap and the other a checkerboard.
std::optional<Parameter> pair_of_numbers(Scene& scene, const Parameter& u, const Parameter& v);

/// Whether the parameter's texture holds a number of its own for each of x and y.
bool holds_two_numbers(const Scene& scene, const Parameter& parameter);

}  // namespace nearlight::core
