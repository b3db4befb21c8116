// SPDX-License-Identifier: Apache-2.0
#include "host/scene/vertex_colors.h"

#include <algorithm>
#include <cmath>

#include "host/image/color.h"
#include "host/scene/material_model.h"
#include "host/scene/mesh.h"

namespace nearlight::core {
namespace {

/// How much the parameter scales the colours of vertices; 0 if it does not look them up.
float vertex_color_scale(const Scene& scene, const Parameter& parameter) {
    if (parameter.texture < 0) {
        return 0.0f;
    }
    const Texture& texture = scene.textures[static_cast<std::size_t>(parameter.texture)].parameters;
    const float scale = max_component(parameter.value);
    if (texture.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return scale *
               std::max(vertex_color_scale(scene, texture.color0), vertex_color_scale(scene, texture.color1));
    }
    const bool asks = texture.kind == NEARLIGHT_TEXTURE_VERTEX_COLOR ||
                      (texture.flags & NEARLIGHT_TEXTURE_TIMES_COLOR) != 0;
    return asks ? scale : 0.0f;
}

/// The same of a material and all that it stands for.
float vertex_color_scale(const Scene& scene, const Material& material) {
    float scale = 0.0f;
    for (const Parameter Material::*member : kMaterialParameters) {
        scale = std::max(scale, vertex_color_scale(scene, material.*member));
    }
    if (material.model >= NEARLIGHT_BSDF_MASK) {
        for (const uint child : material.child) {
            scale = std::max(scale, vertex_color_scale(scene, scene.materials[child]));
        }
    }
    return scale;
}

}  // namespace

void decode_display_colors(std::span<Vec3> colors) {
    const auto is_whole = [](Vec3 c) {
        return c.x == std::floor(c.x) && c.y == std::floor(c.y) && c.z == std::floor(c.z);
    };
    const bool are_bytes =
        std::ranges::all_of(colors, is_whole) &&
        std::ranges::any_of(colors, [](Vec3 color) { return max_component(color) > 1.0f; });
    for (Vec3& color : colors) {
        if (color == kNoColor) {
            continue;
        }
        const Vec3 encoded = are_bytes ? color / 255.0f : color;
        color = {srgb_to_linear(encoded.x), srgb_to_linear(encoded.y), srgb_to_linear(encoded.z)};
    }
}

void finish_vertex_colors(Scene& scene, NoteSink& notes) {
    std::vector<float> scales;
    for (const Material& material : scene.materials) {
        scales.push_back(vertex_color_scale(scene, material));
    }
    if (std::ranges::all_of(scales, [](float scale) { return scale == 0.0f; })) {
        scene.vertex_colors = {};
        return;
    }
    scene.vertex_colors.resize(scene.vertices.size(), kNoColor);
    bool is_missing = false;
    bool is_bright = false;
    for (const Triangle& triangle : scene.triangles) {
        const float scale = scales[triangle.material];
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            const Vec3 color = scene.vertex_colors[vertex];
            is_missing = is_missing || (scale > 0.0f && color == kNoColor);
            is_bright = is_bright || max_component(color) * scale > 1.0f;
        }
    }
    if (is_missing) {
        notes.approximation(scene.source, 0,
                            "a texture asks for colours of vertices, but the mesh has none; white is used");
    }
    if (is_bright) {
        notes.remark(scene.source, 0,
                     "colours of vertices are above 1; surfaces reflect more light than they receive");
    }
    std::ranges::replace(scene.vertex_colors, kNoColor, Vec3{1, 1, 1});
}

}  // namespace nearlight::core
