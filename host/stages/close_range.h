// SPDX-License-Identifier: Apache-2.0
// The close range of a camera: what it sees, up to a distance. Its predicate on points is in
// kernels/lib/close_range.cl.
#pragma once

#include "kernels/shared/types.h"

namespace nearlight::core {

/// The four sides of the view frustum, then the plane through the camera that faces forward; `range` in
/// metres, may be infinite.
CloseRange make_close_range(const PinholeCamera& camera, float range);

/// Whether a point, however far away, is in the view frustum or at most `margin` metres beyond each of its
/// planes. What hides it does not matter.
bool in_frustum(const CloseRange& close, Vec3 point, float margin);

}  // namespace nearlight::core
