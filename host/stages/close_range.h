// SPDX-License-Identifier: Apache-2.0
// The close range of a camera: the part of its view frustum up to a distance. kernels/lib/close_range.cl
// decides which points lie in it.
#pragma once

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Makes the close range from the four sides of the view frustum and the plane at the near clip that faces
/// forward. It holds all that is seen nearer than `range`, through any part of a lens. `range` is in metres
/// and may be infinite.
CloseRange make_close_range(const Camera& camera, float range);

/// Whether a point, however far away, is in the view frustum or at most `margin` metres beyond each of its
/// planes. Points that something hides count too.
bool in_frustum(const CloseRange& close, Vec3 point, float margin);

}  // namespace nearlight::core
