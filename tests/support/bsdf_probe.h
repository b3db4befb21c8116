// SPDX-License-Identifier: Apache-2.0
// Asks the device for BSDFs of points on a few triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/stages/bsdf_probe.h"

namespace nearlight::core::test {

inline constexpr uint kPartD = 1;  ///< BSDF_D of kernels/lib/bsdf/bsdf.cl
inline constexpr uint kPartS = 2;  ///< BSDF_S
inline constexpr uint kBothParts = 3;
inline constexpr uint kRadiance = 0;  ///< BSDF_RADIANCE of kernels/lib/bsdf/surface.cl
inline constexpr uint kFlux = 1;      ///< BSDF_FLUX

/// A material without textures; all its parameters are 0 but for tints, which are 1, and indices, 1.5.
inline Material make_material(uint model) {
    const Parameter zero{{0, 0, 0}, -1};
    const Parameter one{{1, 1, 1}, -1};
    Material material{};
    for (Parameter* p = &material.reflectance; p <= &material.clearcoat_gloss; ++p) {
        *p = zero;
    }
    material.specular = material.transmission = one;
    material.eta = {1.5f, 1.5f, 1.5f};
    material.model = model;
    return material;
}

inline Parameter constant(Vec3 value) {
    return {value, -1};
}
inline Parameter constant(float value) {
    return {{value, value, value}, -1};
}

/// The query for a viewer and a direction of light at the middle of triangle 0.
inline BsdfQuery make_query(Vec3 wo, Vec3 wi, uint parts, uint mode = kRadiance) {
    return {.wo = wo,
            .triangle = 0,
            .wi = wi,
            .parts = parts,
            .weight1 = 0.25f,
            .weight2 = 0.25f,
            .mode = mode,
            .choice = 0.0f,
            .u = 0.0f,
            .v = {0.0f, 0.0f},
            .pad0 = 0};
}

inline void draw_numbers(BsdfQuery& query, Pcg32& random) {
    query.choice = random.uniform();
    query.u = random.uniform();
    query.v[0] = random.uniform();
    query.v[1] = random.uniform();
}

/// A direction with the polar angle (degrees; 0 is +z, 180 is −z) and an azimuth that is no multiple of 45°.
inline Vec3 direction_at(float degrees, float azimuth = 0.6435f) {
    const float theta = degrees * kPi / 180.0f;
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

inline Vec3 random_direction(Pcg32& random) {
    const float z = 2.0f * random.uniform() - 1.0f;
    const float phi = 2.0f * kPi * random.uniform();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace nearlight::core::test
