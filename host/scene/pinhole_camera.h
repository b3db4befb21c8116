// SPDX-License-Identifier: Apache-2.0
// The camera as kernels take it.
#pragma once

#include "host/scene/scene.h"

namespace nearlight {

/// For a film of width × height pixels; the horizontal field of view is the scene camera's, the vertical one follows.
PinholeCamera make_pinhole_camera(const SceneCamera& camera, int width, int height);

}  // namespace nearlight
