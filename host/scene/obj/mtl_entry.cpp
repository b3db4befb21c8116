// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/mtl_entry.h"

#include <algorithm>
#include <cmath>

#include "host/scene/material_model.h"

namespace nearlight::core::mtl {
namespace {

/// Whether the entry has the extension for physically based rendering.
bool is_physically_based(const tinyobj::material_t& entry) {
    return entry.roughness > 0 || entry.metallic > 0 || !entry.roughness_texname.empty() ||
           !entry.metallic_texname.empty();
}

/// Maya gives illum 4 to all materials. So that model alone makes no glass of a surface that has a colour of
/// its own, an opacity of 1 and no index of refraction. Blender's illum 6 is transparent metal, and its
/// illum 9 any other surface with an opacity below 1.
bool is_glass(const tinyobj::material_t& entry, bool is_blenders) {
    const bool is_opaque = entry.dissolve >= 1.0f && entry.ior <= 1.001f &&
                           (!is_zero(to_vec3(entry.diffuse)) || !entry.diffuse_texname.empty());
    return entry.illum == 7 || ((entry.illum == 6 || entry.illum == 9) && !is_blenders) ||
           (entry.illum == 4 && !is_opaque);
}

/// Blender's illum 3 and 6 are metal.
bool is_blenders_metal(const tinyobj::material_t& entry) {
    return entry.illum == 3 || entry.illum == 6;
}

}  // namespace

Look look_of(const tinyobj::material_t& entry, bool is_blenders) {
    if (is_glass(entry, is_blenders)) {
        return Look::glass;
    }
    if (is_physically_based(entry)) {
        return Look::principled;
    }
    if (is_blenders && (is_blenders_metal(entry) || (has_highlight(entry) && entry.illum != 5))) {
        return Look::blenders_principled;
    }
    if (entry.illum == 3 || entry.illum == 5) {
        return Look::mirror;
    }
    return has_highlight(entry) ? Look::plastic : Look::diffuse;
}

bool has_highlight(const tinyobj::material_t& entry) {
    return entry.illum != 1 && !is_zero(clamped(to_vec3(entry.specular)));
}

double index_of(const tinyobj::material_t& entry) {
    return entry.ior > 1.001f ? static_cast<double>(entry.ior) : kUsualIndex;
}

double alpha_of_exponent(double exponent) {
    return std::sqrt(2.0 / (std::min(std::max(0.0, exponent), 1e6) + 2.0));
}

float blenders_roughness(float exponent, float smooth_exponent) {
    return 1.0f - std::sqrt(std::clamp(exponent / smooth_exponent, 0.0f, 1.0f));
}

float blenders_metalness(const tinyobj::material_t& entry) {
    return is_blenders_metal(entry) ? std::clamp(entry.ambient[0], 0.0f, 1.0f) : 0.0f;
}

Vec3 hue(Vec3 color) {
    return is_zero(color) ? Vec3{1, 1, 1} : color / max_component(color);
}

}  // namespace nearlight::core::mtl
