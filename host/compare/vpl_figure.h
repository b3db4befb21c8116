// SPDX-License-Identifier: Apache-2.0
// Where the VPLs are: the paper's figure 1.
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
    float distance = 0;  ///< from the camera, scene units
};
/// Where the camera sees a point; nothing behind it or outside the picture.
std::optional<FilmPoint> project(const SceneCamera& camera, Vec3 point);

struct VplDots {
    Image picture;  ///< R, G, B, ready to be looked at; a whole number of times as wide as the overview
    std::size_t vpls = 0;        ///< of the whole set
    std::size_t in_picture = 0;  ///< before the camera and within the picture
    std::size_t visible = 0;     ///< of those, not behind anything
};

/// `overview`: the scene, R, G, B; it is dimmed. `depths`: distance of the first surface for each of its
/// pixels, 0 where there is none. Those placed in the close range are orange, others blue; those behind
/// something are fainter and smaller.
VplDots draw_vpls(const Image& overview, std::span<const float> depths, const SceneCamera& camera,
                  std::span<const Vpl> vpls);

}  // namespace nearlight::core
