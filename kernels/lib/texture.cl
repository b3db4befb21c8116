// SPDX-License-Identifier: Apache-2.0
// Textures, and parameters of materials that textures scale. host/scene/texture.h has the same arithmetic.
#ifndef NEARLIGHT_LIB_TEXTURE
#define NEARLIGHT_LIB_TEXTURE

#include "lib/scene.cl"
#include "lib/srgb_table.cl"

/// What a parameter is at a point. A number takes from a texture the luminance of its colour, as in Mitsuba,
/// unless the texture holds two numbers.
typedef struct TextureValue {
    float3 color;
    float2 number;    // where the parameter is one number or two
    float2 gradient;  // of the colour's luminance along u and v; 0 but for bitmaps with bilinear filter that
                      // lie in no checkerboard
} TextureValue;

/// The index of the texel that stands at place i of a row or column of n texels.
static inline int wrap_texel(int i, int n, uint wrap) {
    if (i >= 0 && i < n) {
        return i;  // most do, and are spared the divisions
    }
    if (wrap == NEARLIGHT_WRAP_CLAMP) {
        return clamp(i, 0, n - 1);
    }
    const int period = wrap == NEARLIGHT_WRAP_MIRROR ? 2 * n : n;
    i %= period;
    i += i < 0 ? period : 0;
    return i < n ? i : period - 1 - i;
}

static inline float3 load_texel(const SceneView* scene, const global Texture* texture, int x, int y) {
    const int width = (int)texture->width;
    const int height = (int)texture->height;
    const uint index =
        (uint)(wrap_texel(y, height, texture->wrap_t) * width + wrap_texel(x, width, texture->wrap_s));
    const global uint* words = scene->texels + texture->first_word;
    if (texture->format == NEARLIGHT_TEXELS_HALF) {
        return vload_half4(index, (const global half*)words).xyz;
    }
    const uint word = words[index];
    const uint3 codes = (uint3)(word & 255u, (word >> 8) & 255u, (word >> 16) & 255u);
    if (texture->format == NEARLIGHT_TEXELS_LINEAR8) {
        return convert_float3(codes) / 255.0f;
    }
    return (float3)(kSrgbToLinear[codes.x], kSrgbToLinear[codes.y], kSrgbToLinear[codes.z]);
}

/// A coordinate near 0 where the texture looks the same, so that large coordinates lose no precision. One
/// that is no finite number counts as 0.
static inline float reduce_coordinate(float s, uint wrap) {
    if (!isfinite(s)) {
        return 0.0f;
    }
    return wrap == NEARLIGHT_WRAP_CLAMP ? clamp(s, -1.0f, 2.0f) : s - 2.0f * floor(0.5f * s);
}

static inline TextureValue look_up_bitmap(const SceneView* scene, const global Texture* texture, float s,
                                          float t) {
    TextureValue value = {(float3)(0.0f), (float2)(0.0f), (float2)(0.0f)};
    const bool nearest = texture->filter == NEARLIGHT_FILTER_NEAREST;
    const float2 size = (float2)((float)texture->width, (float)texture->height);
    const float x = reduce_coordinate(s, texture->wrap_s) * size.x - (nearest ? 0.0f : 0.5f);
    const float y = (1.0f - reduce_coordinate(t, texture->wrap_t)) * size.y - (nearest ? 0.0f : 0.5f);
    const int x0 = (int)floor(x);
    const int y0 = (int)floor(y);
    if (nearest) {
        value.color = load_texel(scene, texture, x0, y0);
        return value;
    }
    const float fx = x - (float)x0;
    const float fy = y - (float)y0;
    float2 step = (float2)(0.0f);  // change of luminance for a texel to the right and one down
#pragma unroll 1
    for (int i = 0; i < 4; ++i) {
        const bool right = i & 1;
        const bool down = i & 2;
        const float wx = right ? fx : 1.0f - fx;
        const float wy = down ? fy : 1.0f - fy;
        const float3 texel = load_texel(scene, texture, x0 + (i & 1), y0 + (i >> 1));
        value.color += wx * wy * texel;
        step += luminance(texel) * (float2)(right ? wy : -wy, down ? wx : -wx);
    }
    step *= (float2)(size.x, -size.y);
    value.gradient = (float2)(texture->u_scale * step.x + texture->v_shear * step.y,
                              texture->u_shear * step.x + texture->v_scale * step.y);
    return value;
}

static inline float3 interpolated_color(const SceneView* scene, const SurfaceHit* hit) {
    const Triangle triangle = scene->triangles[hit->triangle];
    return (1.0f - hit->weights.x - hit->weights.y) * load3(scene->vertex_colors[triangle.v0]) +
           hit->weights.x * load3(scene->vertex_colors[triangle.v1]) +
           hit->weights.y * load3(scene->vertex_colors[triangle.v2]);
}

/// The texture coordinates at which a texture is looked up.
static inline float2 coordinates_for(const SceneView* scene, const global Texture* texture,
                                     const SurfaceHit* hit) {
    if (!(texture->flags & NEARLIGHT_TEXTURE_SECOND_UV)) {
        return hit->uv;
    }
    const Triangle triangle = scene->triangles[hit->triangle];
    return (1.0f - hit->weights.x - hit->weights.y) * scene->second_uvs[triangle.v0] +
           hit->weights.x * scene->second_uvs[triangle.v1] + hit->weights.y * scene->second_uvs[triangle.v2];
}

/// Where a texture lies on texture coordinates: its own point (s, t).
static inline float2 place_on_texture(const global Texture* texture, float2 uv) {
    return (float2)(texture->u_scale * uv.x + texture->u_shear * uv.y + texture->u_offset,
                    texture->v_shear * uv.x + texture->v_scale * uv.y + texture->v_offset);
}

/// The colour of a bitmap at texture coordinates of its own, for lights that send an image; white for any
/// other texture.
static inline float3 texture_color(const SceneView* scene, uint index, float2 uv) {
    const global Texture* texture = scene->textures + index;
    if (texture->kind != NEARLIGHT_TEXTURE_BITMAP) {
        return (float3)(1.0f);
    }
    const float2 st = place_on_texture(texture, uv);
    return look_up_bitmap(scene, texture, st.x, st.y).color;
}

/// The value of a parameter at the point.
static inline TextureValue look_up(const SceneView* scene, const global Parameter* parameter,
                                   const SurfaceHit* hit) {
    TextureValue texel = {(float3)(1.0f), (float2)(0.0f), (float2)(0.0f)};
    const float3 scale = load3(parameter->value);
    float3 field = (float3)(1.0f);  // of the checkerboards on the way
    const bool has_two_numbers = parameter->texture >= 0 && (scene->textures[parameter->texture].flags &
                                                             NEARLIGHT_TEXTURE_TWO_NUMBERS) != 0;
    for (uint nested = 0; parameter->texture >= 0 && nested < NEARLIGHT_MAX_TEXTURE_NESTING; ++nested) {
        const global Texture* texture = scene->textures + parameter->texture;
        const float2 st = place_on_texture(texture, coordinates_for(scene, texture, hit));
        if (texture->kind == NEARLIGHT_TEXTURE_BITMAP) {
            texel = look_up_bitmap(scene, texture, st.x, st.y);
            if (texture->cutoff > 0.0f) {
                texel.color = (float3)(texel.color.x >= texture->cutoff ? 1.0f : 0.0f);
            }
            if (texture->flags & NEARLIGHT_TEXTURE_TIMES_COLOR) {
                texel.color *= interpolated_color(scene, hit);
            }
            if (nested > 0) {
                texel.gradient = (float2)(0.0f);  // Mitsuba's checkerboards have none
            }
            break;
        }
        if (texture->kind == NEARLIGHT_TEXTURE_VERTEX_COLOR) {
            texel.color = interpolated_color(scene, hit);
            break;
        }
        const bool same = (st.x - floor(st.x) > 0.5f) == (st.y - floor(st.y) > 0.5f);
        parameter = same ? &texture->color0 : &texture->color1;
        field *= load3(parameter->value);
    }
    texel.color *= field;
    texel.number = scale.xy * (has_two_numbers ? texel.color.xy : (float2)(luminance(texel.color)));
    texel.gradient *= scale.x;
    texel.color *= scale;
    return texel;
}

#endif
