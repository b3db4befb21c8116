// SPDX-License-Identifier: Apache-2.0
// Takes the pattern out of pictures whose neighbouring pixels ask different VPLs.
#pragma once

#include "nearlight/image.h"

namespace nearlight::viewer {

/// Averages the indirect light that falls on a surface over squares of `side` × `side` pixels, as far as
/// their normals and depths say that they show the same surface [Keller & Heidrich, Interleaved Sampling,
/// 2001]. Layers and textures stay sharp, because it is the light that is averaged and not what surfaces
/// reflect of it; reflections in coats and glass lose detail. The picture must have all channels of
/// picture_channels().
void smooth_interleaved(Image& image, int side);

}  // namespace nearlight::viewer
