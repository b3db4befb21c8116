// SPDX-License-Identifier: Apache-2.0
// Textures and the two albedos of a material, as host/scene/scene.h defines them.
#ifndef NEARLIGHT_LIB_MATERIAL
#define NEARLIGHT_LIB_MATERIAL

#include "lib/scene.cl"
#include "lib/srgb_table.cl"

inline float3 load_texel(const SceneView* scene, const global Texture* texture, int x, int y) {
    const int width = (int)texture->width;
    const int height = (int)texture->height;
    x %= width;
    y %= height;
    x += x < 0 ? width : 0;
    y += y < 0 ? height : 0;
    const uint texel = scene->texels[texture->first_texel + (uint)(y * width + x)];
    return (float3)(kSrgbToLinear[texel & 255u], kSrgbToLinear[(texel >> 8) & 255u],
                    kSrgbToLinear[(texel >> 16) & 255u]);
}

inline float3 sample_texture(const SceneView* scene, uint index, float2 uv) {
    const global Texture* texture = scene->textures + index;
    const float s = texture->u_scale * uv.x + texture->u_shear * uv.y + texture->u_offset;
    const float t = texture->v_shear * uv.x + texture->v_scale * uv.y + texture->v_offset;
    if (texture->kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        const bool s_low = s - floor(s) < 0.5f;
        const bool t_low = t - floor(t) < 0.5f;
        return s_low == t_low ? load3(texture->color0) : load3(texture->color1);
    }
    // Whole repetitions are subtracted first, so that large coordinates lose no precision. Row 0 is the top.
    const float x = (s - floor(s)) * (float)texture->width - 0.5f;
    const float y = (1.0f - (t - floor(t))) * (float)texture->height - 0.5f;
    const int x0 = (int)floor(x);
    const int y0 = (int)floor(y);
    const float fx = x - (float)x0;
    const float fy = y - (float)y0;
    const float3 top = mix(load_texel(scene, texture, x0, y0), load_texel(scene, texture, x0 + 1, y0), fx);
    const float3 bottom =
        mix(load_texel(scene, texture, x0, y0 + 1), load_texel(scene, texture, x0 + 1, y0 + 1), fx);
    return mix(top, bottom, fy);
}

inline float3 base_reflectance(const SceneView* scene, const global Material* material, float2 uv) {
    const float3 base = load3(material->base);
    return material->base_texture < 0 ? base : base * sample_texture(scene, (uint)material->base_texture, uv);
}

/// The Lambertian reflectance that the camera sees, without the coat's Fresnel factor.
inline float3 camera_albedo(const SceneView* scene, const global Material* material, float2 uv) {
    const float3 t = base_reflectance(scene, material, uv);
    return t * material->base_scale / (1.0f - material->base_saturation * t);
}

/// The reflectance that light transport sees.
inline float3 light_albedo(const SceneView* scene, const global Material* material, float2 uv) {
    const float3 t = base_reflectance(scene, material, uv);
    return t * material->light_scale / (1.0f - material->base_saturation * t) + load3(material->light_offset);
}

/// Whether the side that a ray met reflects anything; `front` is 0 for the back.
inline bool reflects(const global Material* material, uint front) {
    return front || (material->flags & NEARLIGHT_MATERIAL_TWO_SIDED);
}

#endif
