// SPDX-License-Identifier: Apache-2.0
#include "host/scene/sky/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/sky/sky_model.h"

namespace nearlight::core {
namespace {

constexpr int kSkyWidth = 1024;
constexpr int kSkyHeight = 512;

/// Fills the map with the mean of four points of each pixel; below the horizon it is black. The map's up is
/// +Y, the model's is +Z.
void bake_sky(EnvironmentLight& light, const SkyModel& model, Vec3 sun, float scale) {
    light.width = kSkyWidth;
    light.height = kSkyHeight;
    light.radiance.assign(std::size_t{kSkyWidth} * kSkyHeight, {0, 0, 0});
    for (int row = 0; row < kSkyHeight / 2; ++row) {
        for (int column = 0; column < kSkyWidth; ++column) {
            Vec3 sum{0, 0, 0};
            for (int part = 0; part < 4; ++part) {
                const double theta = std::numbers::pi * (row + 0.25 + 0.5 * (part / 2)) / kSkyHeight;
                const double phi = 2 * std::numbers::pi * (column + 0.25 + 0.5 * (part % 2)) / kSkyWidth;
                // In the map's frame (sin φ·sin θ, cos θ, −cos φ·sin θ); its −Z is the model's Y.
                const Vec3 direction{static_cast<float>(std::sin(phi) * std::sin(theta)),
                                     static_cast<float>(std::cos(phi) * std::sin(theta)),
                                     static_cast<float>(std::cos(theta))};
                const double gamma =
                    std::acos(std::clamp(static_cast<double>(dot(direction, sun)), -1.0, 1.0));
                sum += model.radiance(std::cos(theta), gamma) * (0.25f * scale);
            }
            light.radiance[static_cast<std::size_t>(row) * kSkyWidth + static_cast<std::size_t>(column)] =
                sum;
        }
    }
}

double elevation_of(Vec3 sun) {
    return std::asin(std::min(static_cast<double>(sun.z), 1.0));
}

}  // namespace

Mat4 sky_map_to_model() {
    return rotation(1, 0, 0, 90);
}

void set_sun(EnvironmentLight& light, const SkyLight& sky, Vec3 to_sun) {
    const double solid_angle = 4.0 * std::numbers::pi * std::pow(std::sin(0.5 * sky.sun_half_angle), 2.0);
    light.sun_direction = to_sun;
    light.sun_half_angle = static_cast<float>(sky.sun_half_angle);
    light.sun_radiance = sun_irradiance(sky.turbidity, elevation_of(sky.sun)) *
                         (static_cast<float>(sky.sun_scale) / static_cast<float>(solid_angle));
}

void set_sky(EnvironmentLight& light, const SkyLight& sky) {
    light.width = light.height = 1;
    light.radiance = {{0, 0, 0}};
    if (sky.sky_scale > 0.0) {
        bake_sky(light, SkyModel(sky.turbidity, sky.albedo, elevation_of(sky.sun)), sky.sun,
                 static_cast<float>(sky.sky_scale));
    }
    if (sky.sun_scale > 0.0) {
        const Vec3 sun = sky.sun;
        set_sun(light, sky, normalize(transform_vector(light.to_world, {sun.x, sun.z, -sun.y})));
    }
}

}  // namespace nearlight::core
