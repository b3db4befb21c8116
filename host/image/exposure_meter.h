// SPDX-License-Identifier: Apache-2.0
// Chooses the exposure of a picture by the light of the surfaces in it.
#pragma once

#include <span>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core {

class ExposureMeter {
  public:
    /// Takes a pixel that shows a surface of the given albedo. What counts is the geometric mean of the light
    /// that comes from it and of the light that falls on it, so that dark things stay rather dark and white
    /// ones white; of a surface that reflects nothing diffusely, the light that comes from it counts.
    void add_surface(Vec3 color, Vec3 albedo);

    /// The exposure in stops (tone_curve.h). If there was no surface, it is that of `all_rgb`, which has
    /// three values for each pixel of the picture.
    [[nodiscard]] float exposure(std::span<const float> all_rgb) const;

  private:
    std::vector<float> metered_;
};

}  // namespace nearlight::core
