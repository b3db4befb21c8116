// SPDX-License-Identifier: Apache-2.0
#include "host/scene/number_pair.h"

#include <utility>

#include "host/base/half.h"
#include "host/scene/texture.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core {
namespace {

const SceneTexture& texture_of(const Scene& scene, const Parameter& parameter) {
    return scene.textures[static_cast<std::size_t>(parameter.texture)];
}

bool lie_alike(const Texture& a, const Texture& b) {
    return a.u_scale == b.u_scale && a.u_shear == b.u_shear && a.u_offset == b.u_offset &&
           a.v_shear == b.v_shear && a.v_scale == b.v_scale && a.v_offset == b.v_offset && a.flags == b.flags;
}

/// Whether texels of the two bitmaps with the same index are looked up together everywhere.
bool match(const Scene& scene, const SceneTexture& a, const SceneTexture& b) {
    const TextureImage& first = scene.images[static_cast<std::size_t>(a.image)];
    const TextureImage& second = scene.images[static_cast<std::size_t>(b.image)];
    return first.width == second.width && first.height == second.height &&
           a.parameters.wrap_s == b.parameters.wrap_s && a.parameters.wrap_t == b.parameters.wrap_t &&
           a.parameters.filter == b.parameters.filter;
}

/// What the texture of a number says in a texel; 1 for a number without a texture.
float texel_number(const Scene& scene, const Parameter& parameter, std::size_t texel) {
    if (parameter.texture < 0) {
        return 1.0f;
    }
    const int image = texture_of(scene, parameter).image;
    return luminance(texel_color(scene.images[static_cast<std::size_t>(image)], texel));
}

/// The image with the numbers of u in red and those of v in green.
int add_image(Scene& scene, const SceneTexture& like, const Parameter& u, const Parameter& v) {
    const TextureImage& source = scene.images[static_cast<std::size_t>(like.image)];
    TextureImage image{source.name, source.width, source.height, NEARLIGHT_TEXELS_HALF, {}};
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    image.words.reserve(2 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t red = float_to_half(texel_number(scene, u, i));
        const std::uint32_t green = float_to_half(texel_number(scene, v, i));
        image.words.push_back(red | (green << 16u));
        image.words.push_back(0x3c000000u);  // no blue; alpha is 1
    }
    scene.images.push_back(std::move(image));
    return static_cast<int>(scene.images.size() - 1);
}

/// The number that the texture's field has, where the parameter's texture is a checkerboard; otherwise 1.
Parameter field(const Scene& scene, const Parameter& parameter, Parameter Texture::*color) {
    return parameter.texture < 0 ? Parameter{kWhite, -1} : texture_of(scene, parameter).parameters.*color;
}

/// Replaces the fields of a checkerboard by pairs of the fields of u and v; false if these are no pairs.
bool pair_fields(Scene& scene, SceneTexture& board, const Parameter& u, const Parameter& v) {
    for (Parameter Texture::*const color : {&Texture::color0, &Texture::color1}) {
        const std::optional<Parameter> pair =
            pair_of_numbers(scene, field(scene, u, color), field(scene, v, color));
        if (!pair) {
            return false;
        }
        board.parameters.*color = *pair;
    }
    return true;
}

}  // namespace

std::optional<Parameter> pair_of_numbers(Scene& scene, const Parameter& u, const Parameter& v) {
    Parameter pair{{u.value.x, v.value.x, 0.0f}, u.texture};
    if (u.texture == v.texture) {
        return pair;
    }
    SceneTexture both = texture_of(scene, u.texture < 0 ? v : u);
    const bool has_two = u.texture >= 0 && v.texture >= 0;
    const SceneTexture other = texture_of(scene, v.texture < 0 ? u : v);
    if (has_two &&
        (both.parameters.kind != other.parameters.kind || !lie_alike(both.parameters, other.parameters))) {
        return std::nullopt;
    }
    if (both.parameters.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        if (!pair_fields(scene, both, u, v)) {
            return std::nullopt;
        }
    } else if (both.parameters.kind == NEARLIGHT_TEXTURE_BITMAP && match(scene, both, other)) {
        both.image = add_image(scene, both, u, v);
    } else {
        return std::nullopt;
    }
    both.parameters.flags |= NEARLIGHT_TEXTURE_TWO_NUMBERS;
    pair.texture = add_texture(scene, both);
    return pair;
}

bool holds_two_numbers(const Scene& scene, const Parameter& parameter) {
    return parameter.texture >= 0 &&
           (texture_of(scene, parameter).parameters.flags & NEARLIGHT_TEXTURE_TWO_NUMBERS) != 0;
}

}  // namespace nearlight::core
