// SPDX-License-Identifier: Apache-2.0
// Chooses the exposure of a picture by the light of the surfaces in it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core {

class ExposureMeter {
  public:
    /// Takes a pixel that shows something at a distance of `depth`, whose albedo is given, or the background
    /// if the depth is 0 or infinite. What counts is the geometric mean of the light that comes from a
    /// surface and of the light that falls on it, so that dark things stay rather dark and white ones white;
    /// of a surface that reflects nothing diffusely, the light that comes from it counts. The background
    /// counts only in a picture of nothing else.
    void add(Vec3 color, float depth, Vec3 albedo);

    /// The exposure in stops, from -60 to 60, at which the picture looks right on a screen: what is seen is
    /// grey on the average, and hardly anything is white. Pixels that are black, or more than ten stops
    /// darker than half of the others, do not count, because a screen shows them black at any such exposure.
    /// A picture of black pixels alone has the exposure 0.
    [[nodiscard]] float exposure() const;

  private:
    /// The light of a part of the picture.
    struct Light {
        std::vector<float> luminances;  ///< of pixels that are not black
        std::vector<float> brightest;   ///< the largest component of each of them

        void add(Vec3 color);
        /// The mean logarithm to the base 2 of the luminances that count.
        [[nodiscard]] double mean_log2() const;
    };
    Light surfaces_;
    Light background_;
};

/// The exposure of a picture with interleaved channels R, G and B. Without albedo.R, albedo.G, albedo.B and
/// depth.Z, it counts as background. Throws Error(ErrorKind::invalid_argument) if R, G or B is missing.
float automatic_exposure(std::span<const std::string> channels, std::span<const float> values);

}  // namespace nearlight::core
