// SPDX-License-Identifier: Apache-2.0
// The positions of VPLs as a picture: the paper's figure 1.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "host/image/image.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct FilmPoint {
    float x = 0;  ///< pixels from the top left corner
    float y = 0;
    float distance = 0;  ///< from the camera, m
};
/// The place where the camera sees a point; empty for a point behind the camera or outside the picture.
std::optional<FilmPoint> project(const SceneCamera& camera, Vec3 point);

struct VplDots {
    Image picture;               ///< R, G, B, scaled for display; its width is a multiple of the overview's
    std::size_t vpls = 0;        ///< number of VPLs of the whole set
    std::size_t in_picture = 0;  ///< VPLs in front of the camera and within the picture
    std::size_t visible = 0;     ///< VPLs of in_picture that nothing hides
};

/// Draws VPLs as dots over the dimmed `overview` (R, G, B). `depths` has the distance of the first surface
/// for each of its pixels, or 0. VPLs placed in the close range are orange, others blue; hidden ones are
/// fainter and smaller.
VplDots draw_vpls(const Image& overview, std::span<const float> depths, const SceneCamera& camera,
                  std::span<const Vpl> vpls);

}  // namespace nearlight::core
