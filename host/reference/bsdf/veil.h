// SPDX-License-Identifier: Apache-2.0
// What surfaces let pass straight on: the share that a shadow ray keeps.
#pragma once

#include "host/base/vec3d.h"
#include "host/reference/surface.h"

namespace nearlight::core {

/// The share of the light along the unit direction that passes the surface straight, over all choices of
/// masks and blends: thin panes, masks and `null`, and smooth glass bodies where the scene has clear glass.
/// Whatever lies under a normal or bump map counts as opaque.
Vec3d veil_transmittance(const Scene& scene, const Surface& surface, Vec3d direction);

}  // namespace nearlight::core
