// SPDX-License-Identifier: Apache-2.0
// What an entry of a material library says about a surface. Programs give some words meanings of their own.
#pragma once

#include <tiny_obj_loader.h>

#include "host/base/math.h"

namespace nearlight::core::mtl {

inline Vec3 to_vec3(const tinyobj::real_t (&c)[3]) {
    return {c[0], c[1], c[2]};
}
inline Vec3 clamped(Vec3 c) {
    return min(max(c, {0, 0, 0}), {1, 1, 1});
}

/// What the words of an entry mean together.
enum class Look { glass, principled, mirror, blenders_principled, plastic, diffuse };
/// `is_blenders`: the exporter of Blender 2.80 or later wrote the entry.
Look look_of(const tinyobj::material_t& entry, bool is_blenders);

/// Whether the surface has highlights: illumination model 1 has none, whatever Ks says.
bool has_highlight(const tinyobj::material_t& entry);
/// The index of refraction, Ni; files that say 1 or nothing mean that of glass and plastics.
double index_of(const tinyobj::material_t& entry);

/// The roughness α of Beckmann's microfacets that are as rough as a highlight with the exponent Ns [Walter et
/// al., Microfacet Models for Refraction through Rough Surfaces, 2007].
double alpha_of_exponent(double exponent);
/// The inverse of Blender's Ns = smooth_exponent·(1 − roughness)².
float blenders_roughness(float exponent, float smooth_exponent);
/// Blender writes the metalness of what is metal as Ka.
float blenders_metalness(const tinyobj::material_t& entry);
/// The colour with its largest component at 1, or white for black. Programs agree about the colour of Tf, but
/// not whether a small one means dark or clear glass.
Vec3 hue(Vec3 color);

}  // namespace nearlight::core::mtl
