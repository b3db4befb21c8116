// SPDX-License-Identifier: Apache-2.0
// Reads latitude-longitude maps. kernels/lib/light/environment.cl does the same.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/scene.h"

namespace nearlight::core {

/// A pixel of a map.
struct MapPixel {
    uint column = 0;
    uint row = 0;
};

/// The size of a map and how it is read.
struct MapShape {
    uint width = 0;
    uint height = 0;
    bool is_interpolated = false;  ///< EnvironmentLight::is_interpolated
};

/// The pixel that a direction of the map's own frame, a unit vector, falls into.
inline MapPixel pixel_towards(const MapShape& map, Vec3 local) {
    float azimuth = std::atan2(local.x, -local.z) / (2.0f * kPi);
    azimuth -= std::floor(azimuth);
    const float inclination = std::acos(std::clamp(local.y, -1.0f, 1.0f)) / kPi;
    return {std::min(static_cast<uint>(azimuth * static_cast<float>(map.width)), map.width - 1),
            std::min(static_cast<uint>(inclination * static_cast<float>(map.height)), map.height - 1)};
}

/// The radiance between pixels. Columns have their centres at (i + 0.5)/width, and rows lie at i/(height −
/// 1), as in Mitsuba's `envmap`.
template <typename RadianceOf>
Vec3 interpolated_radiance(const MapShape& map, Vec3 local, const RadianceOf& radiance_of) {
    const auto width = static_cast<double>(map.width);
    const auto height = static_cast<double>(map.height);
    const double turn = std::atan2(double{local.x}, -double{local.z}) / (2.0 * std::numbers::pi);
    const double x = (turn - std::floor(turn)) * width - 0.5;
    const double y = std::acos(std::clamp(double{local.y}, -1.0, 1.0)) / std::numbers::pi * (height - 1.0);
    const double left = std::floor(x);
    const double top = std::min(std::floor(y), std::max(height - 2.0, 0.0));
    Vec3 sum{0, 0, 0};
    for (const double right : {0.0, 1.0}) {
        for (const double below : {0.0, 1.0}) {
            const double weight_x = right > 0.0 ? x - left : 1.0 - (x - left);
            const double weight_y = below > 0.0 ? y - top : 1.0 - (y - top);
            const double column = left + right;
            const double wrapped = column < 0.0 ? width - 1.0 : (column >= width ? 0.0 : column);
            const double row = std::min(top + below, height - 1.0);
            sum += radiance_of(MapPixel{static_cast<uint>(wrapped), static_cast<uint>(row)}) *
                   static_cast<float>(weight_x * weight_y);
        }
    }
    return sum;
}

/// The map's radiance in a direction of its own frame, a unit vector. radiance_of(MapPixel) says what pixels
/// have; there must be one.
template <typename RadianceOf>
Vec3 map_radiance(const MapShape& map, Vec3 local, const RadianceOf& radiance_of) {
    return map.is_interpolated ? interpolated_radiance(map, local, radiance_of)
                               : radiance_of(pixel_towards(map, local));
}

}  // namespace nearlight::core
