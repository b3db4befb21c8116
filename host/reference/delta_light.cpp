// SPDX-License-Identifier: Apache-2.0
#include "host/reference/delta_light.h"

#include <algorithm>
#include <cmath>

#include "host/scene/texture.h"

namespace nearlight::core {
namespace {

double dot_double(Vec3 a, Vec3 b) {
    return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z;
}

/// A place in the frame of a light that sends an image.
struct PointOnImage {
    double s, t;
    double depth;  ///< along the axis, m

    PointOnImage(const Emitter& emitter, Vec3 from_light)
        : s(0.5 + dot_double(from_light, emitter.x_axis) / dot_double(from_light, emitter.direction)),
          t(0.5 + dot_double(from_light, emitter.y_axis) / dot_double(from_light, emitter.direction)),
          depth(dot_double(from_light, emitter.direction)) {}
};

Vec3 image_color(const Scene& scene, const Emitter& emitter, const PointOnImage& place) {
    return emitter.image == 0 ? Vec3{1, 1, 1}
                              : texture_color(scene, scene.textures[emitter.image - 1],
                                              static_cast<float>(place.s), static_cast<float>(1 - place.t));
}

Vec3 spot_irradiance(const Scene& scene, const Emitter& emitter, Vec3 from_light, double distance) {
    const PointOnImage place(emitter, from_light);
    const double angle = std::acos(std::clamp(place.depth / distance, -1.0, 1.0));
    if (angle >= emitter.cutoff_angle) {
        return {0, 0, 0};
    }
    const double beam = emitter.beam_angle;
    const double falloff =
        angle <= beam ? 1.0 : (emitter.cutoff_angle - angle) / (emitter.cutoff_angle - beam);
    return emitter.radiance * image_color(scene, emitter, place) *
           static_cast<float>(falloff / (distance * distance));
}

/// A plane across the axis at the depth z receives radiance/z², and an area across the direction to it more
/// by the inverse of the cosine.
Vec3 projector_irradiance(const Scene& scene, const Emitter& emitter, Vec3 from_light, double distance) {
    const PointOnImage place(emitter, from_light);
    if (!(place.depth > 0.0) || std::min(place.s, place.t) < 0.0 || std::max(place.s, place.t) > 1.0) {
        return {0, 0, 0};
    }
    return emitter.radiance * image_color(scene, emitter, place) *
           static_cast<float>(distance / (place.depth * place.depth * place.depth));
}

}  // namespace

DeltaLight delta_light_at(const Scene& scene, const Emitter& emitter, Vec3 position) {
    if (emitter.type == NEARLIGHT_EMITTER_DIRECTIONAL) {
        return {-emitter.direction, emitter.radiance, true};
    }
    const Vec3 from_light = position - emitter.position;
    const double distance = std::sqrt(dot_double(from_light, from_light));
    if (!(distance > 0.0)) {
        return {};
    }
    DeltaLight light;
    light.direction = from_light / static_cast<float>(-distance);
    switch (emitter.type) {
        case NEARLIGHT_EMITTER_POINT:
            light.irradiance = emitter.radiance / static_cast<float>(distance * distance);
            break;
        case NEARLIGHT_EMITTER_SPOT:
            light.irradiance = spot_irradiance(scene, emitter, from_light, distance);
            break;
        case NEARLIGHT_EMITTER_PROJECTOR:
            light.irradiance = projector_irradiance(scene, emitter, from_light, distance);
            break;
        default:  // not a delta light
            break;
    }
    return light;
}

}  // namespace nearlight::core
