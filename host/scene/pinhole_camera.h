// SPDX-License-Identifier: Apache-2.0
// Converts the scene's camera to the struct that ray generation uses.
#pragma once

#include "host/scene/scene.h"

namespace nearlight::core {

/// The camera for a picture of width × height pixels. The horizontal field of view is that of `camera` for
/// any aspect, and pixels are square. Throws Error(ErrorKind::invalid_argument) for a picture without pixels
/// or a field of view that is not between 0 and 180 degrees.
PinholeCamera make_pinhole_camera(const SceneCamera& camera, int width, int height);

}  // namespace nearlight::core
