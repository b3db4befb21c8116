// SPDX-License-Identifier: Apache-2.0
// Measures how soon pictures come when the camera moves, without a window.
#pragma once

#include "viewer/viewer.h"

namespace nearlight::viewer {

/// Moves the camera about the scene for a few seconds as a hand would, then in single moves, and lets a few
/// passes be made. An empty report says that the task was interrupted. Throws what rendering throws.
ViewerReport measure(const ViewerTask& task);

}  // namespace nearlight::viewer
