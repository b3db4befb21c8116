// SPDX-License-Identifier: Apache-2.0
// The region near and before the camera (kernels/lib/close_range.cl tests points against it).
#pragma once

#include "kernels/shared/types.h"

namespace nearlight {

/// The view frustum of the camera up to `range` (m) from its origin. Planes have unit normals that point inside.
CloseRange make_close_range(const PinholeCamera& camera, float range);

}  // namespace nearlight
