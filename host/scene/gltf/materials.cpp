// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/image/image_io.h"
#include "host/scene/material_model.h"
#include "host/scene/texture.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

constexpr double kUsualIndex = 1.5;

Vec3 clamped(Vec3 c) {
    return min(max(c, {0, 0, 0}), {1, 1, 1});
}

Vec3 to_vec3(const std::vector<double>& values, Vec3 fallback) {
    return values.size() < 3 ? fallback
                             : Vec3{static_cast<float>(values[0]), static_cast<float>(values[1]),
                                    static_cast<float>(values[2])};
}

/// Decodes `%20` and its like, because file names in glTF are URIs.
std::string decoded_uri(const std::string& uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            name += static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
            i += 2;
        } else {
            name += uri[i];
        }
    }
    return name;
}

std::string name_of(const tinygltf::Image& image) {
    const std::string kind = image.mimeType == "image/jpeg" ? ".jpg" : ".png";
    return !image.uri.empty() ? image.uri : (image.name.empty() ? "image" : image.name) + kind;
}

Image read_pixels(const GltfFile& file, const tinygltf::Image& image) {
    if (!image.uri.empty()) {
        return read_image(file.path.parent_path() / decoded_uri(image.uri));
    }
    return read_image(
        image.bufferView >= 0 ? bytes_of(file, image.bufferView) : std::as_bytes(std::span(image.image)),
        name_of(image));
}

/// The two numbers `key` of KHR_texture_transform, or `fallback` twice.
std::array<double, 2> pair_of(const tinygltf::Value& transform, const char* key, double fallback) {
    const tinygltf::Value& value = transform.Get(key);
    if (!value.IsArray() || value.ArrayLen() != 2) {
        return {fallback, fallback};
    }
    return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

/// Applies KHR_texture_transform. Vertex has v upwards; glTF has v' = 1 − v downwards and looks textures up
/// at (c·su·u + s·sv·v' + ou, −s·su·u + c·sv·v' + ov).
void apply_transform(const tinygltf::TextureInfo& info, Texture& texture) {
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end()) {
        return;
    }
    const auto [scale_u, scale_v] = pair_of(found->second, "scale", 1);
    const auto [offset_u, offset_v] = pair_of(found->second, "offset", 0);
    const double angle = number_of(info.extensions, "KHR_texture_transform", "rotation", 0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    texture.u_scale = static_cast<float>(c * scale_u);
    texture.u_shear = static_cast<float>(-s * scale_v);
    texture.u_offset = static_cast<float>(s * scale_v + offset_u);
    texture.v_shear = static_cast<float>(s * scale_u);
    texture.v_scale = static_cast<float>(c * scale_v);
    texture.v_offset = static_cast<float>(1 - c * scale_v - offset_v);
}

/// How a sampler repeats a texture [glTF 2.0, 5.26].
uint wrap_of(int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? NEARLIGHT_WRAP_CLAMP
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? NEARLIGHT_WRAP_MIRROR
                                                           : NEARLIGHT_WRAP_REPEAT;
}

/// Normal maps are given per colour texture and so on, with or without a scale; all have these members.
template <typename Info>
tinygltf::TextureInfo plain_info(const Info& info) {
    tinygltf::TextureInfo plain;
    plain.index = info.index;
    plain.texCoord = info.texCoord;
    plain.extensions = info.extensions;
    return plain;
}

int texture_set_of(const tinygltf::TextureInfo& info) {
    return index_of(info.extensions, "KHR_texture_transform", "texCoord", info.texCoord);
}

/// The index at which a dielectric reflects `factor` times as much light head-on.
double scaled_index(double index, double factor) {
    const double root = (index - 1.0) / (index + 1.0);
    const double amplitude = std::min(std::abs(root) * std::sqrt(factor), 0.95);
    return (1.0 + amplitude) / (1.0 - amplitude);
}

}  // namespace

/// The properties that decide which material a glTF material becomes.
struct MaterialMaker::Surface {
    Parameter color;
    Parameter opacity;
    Parameter metallic;
    Parameter roughness;  ///< perceptual: the square root of GGX's α
    double index = kUsualIndex;
    float transmission = 0;
    bool is_thin = true;
    bool reflects = true;

    /// Whether it is a white chalk: reflections as rough as can be are left to the diffuse part.
    [[nodiscard]] bool is_diffuse() const {
        const bool is_metal = metallic.value.x > 0.0f;
        return !reflects || (!is_metal && roughness.texture < 0 && roughness.value.x >= 1.0f);
    }
};

void MaterialMaker::approximate(const std::string& what) {
    notes_.approximation(file_.path, 0, what);
}

int MaterialMaker::load_image(const tinygltf::Image& image, const TexelRule& rule) {
    if (!image.uri.empty()) {
        return textures_.load(file_.path.parent_path() / decoded_uri(image.uri), rule, file_.path, 0);
    }
    try {
        return textures_.add(read_pixels(file_, image), name_of(image), rule, file_.path, 0);
    } catch (const Error& error) {
        throw_unless_file(error);
        notes_.approximation(
            file_.path, 0,
            std::string("texture is replaced by mid-grey because it cannot be read: ") + error.what());
        return -1;
    }
}

/// The texture, scaled by `value`; `value` alone if there is none, and grey if it cannot be read.
Parameter MaterialMaker::textured_by(const tinygltf::TextureInfo& info, Vec3 value, const TexelRule& rule) {
    if (info.index < 0) {
        return parameter_of(value);
    }
    const tinygltf::Texture& source = file_.at(file_.model.textures, info.index, "texture", "a material");
    if (source.source < 0) {
        return parameter_of(value);
    }
    const tinygltf::Image& image = file_.at(file_.model.images, source.source, "image", "a texture");
    const auto [entry, is_new] = images_.try_emplace({source.source, rule}, -1);
    if (is_new) {
        entry->second = load_image(image, rule);
    }
    if (entry->second < 0) {
        return parameter_of(0.5f);
    }
    SceneTexture texture = plain_texture(entry->second);
    apply_transform(info, texture.parameters);
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler =
            file_.at(file_.model.samplers, source.sampler, "sampler", "a texture");
        texture.parameters.wrap_s = wrap_of(sampler.wrapS);
        texture.parameters.wrap_t = wrap_of(sampler.wrapT);
        texture.parameters.filter = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST
                                        ? NEARLIGHT_FILTER_NEAREST
                                        : NEARLIGHT_FILTER_BILINEAR;
    }
    return {value, add_texture(scene_, texture)};
}

/// The opacity of masked and blended surfaces; 1 where the material has no holes.
Parameter MaterialMaker::opacity_of(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const float factor = pbr.baseColorFactor.size() > 3
                             ? std::clamp(static_cast<float>(pbr.baseColorFactor[3]), 0.0f, 1.0f)
                             : 1.0f;
    if (source.alphaMode == "BLEND") {
        return textured_by(pbr.baseColorTexture, Vec3{1, 1, 1} * factor, {.channel = 3});
    }
    if (source.alphaMode != "MASK") {
        return parameter_of(1.0f);
    }
    const auto cutoff = static_cast<float>(source.alphaCutoff);
    if (pbr.baseColorTexture.index < 0 || factor < cutoff) {
        return parameter_of(factor >= cutoff ? 1.0f : 0.0f);
    }
    return cutoff > 0.0f
               ? textured_by(pbr.baseColorTexture, {1, 1, 1}, {.channel = 3, .cutoff = cutoff / factor})
               : parameter_of(1.0f);
}

MaterialMaker::Surface MaterialMaker::surface_of(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const auto share = [](double factor) {
        return Vec3{1, 1, 1} * std::clamp(static_cast<float>(factor), 0.0f, 1.0f);
    };
    Surface surface;
    surface.color = textured_by(pbr.baseColorTexture, clamped(to_vec3(pbr.baseColorFactor, {1, 1, 1})), {});
    surface.opacity = opacity_of(source);
    surface.metallic = textured_by(pbr.metallicRoughnessTexture, share(pbr.metallicFactor), {.channel = 2});
    surface.roughness = textured_by(pbr.metallicRoughnessTexture, share(pbr.roughnessFactor), {.channel = 1});
    surface.index = number_of(source.extensions, "KHR_materials_ior", "ior", kUsualIndex);
    const double specular = number_of(source.extensions, "KHR_materials_specular", "specularFactor", 1);
    const Vec3 tint = color_of(source.extensions, "KHR_materials_specular", "specularColorFactor", {1, 1, 1});
    const double factor = std::max(0.0, specular) * static_cast<double>(std::max(0.0f, luminance(tint)));
    if (tint.x != tint.y || tint.y != tint.z) {
        approximate("the colour of reflections (specularColorFactor) is replaced by its luminance");
    }
    surface.reflects =
        factor > 0.0 && surface.index > 1.0 && !source.extensions.contains("KHR_materials_unlit");
    surface.index = surface.reflects ? scaled_index(surface.index, factor) : kUsualIndex;
    surface.transmission =
        std::clamp(static_cast<float>(
                       number_of(source.extensions, "KHR_materials_transmission", "transmissionFactor", 0)),
                   0.0f, 1.0f);
    surface.is_thin = number_of(source.extensions, "KHR_materials_volume", "thicknessFactor", 0) <= 0;
    return surface;
}

void MaterialMaker::remark_what_is_left_out(const tinygltf::Material& source) {
    for (const char* extension : {"KHR_materials_clearcoat", "KHR_materials_sheen"}) {
        if (source.extensions.contains(extension)) {
            approximate(std::string(extension) + " is left out");
        }
    }
    if (source.alphaMode == "MASK" && source.pbrMetallicRoughness.baseColorTexture.index >= 0) {
        approximate("the edges of alpha masks are smoothed over one texel");
    }
    const int set = texture_set_of(source.pbrMetallicRoughness.baseColorTexture);
    for (const tinygltf::TextureInfo& info : {source.pbrMetallicRoughness.metallicRoughnessTexture,
                                              plain_info(source.normalTexture), source.emissiveTexture}) {
        if (info.index >= 0 && texture_set_of(info) != set) {
            approximate("all textures of a material use the texture coordinates of its colour");
        }
    }
}

/// The emission as a radiance, because exporters write a strength rather than nits.
Parameter MaterialMaker::emission_of(const tinygltf::Material& source) {
    const double strength =
        number_of(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    const Vec3 emission =
        static_cast<float>(strength) * max(to_vec3(source.emissiveFactor, {0, 0, 0}), {0, 0, 0});
    if (!is_finite(emission)) {
        file_.fail("material '" + source.name + "' emits light that is not finite");
    }
    return is_zero(emission) ? parameter_of(0.0f) : textured_by(source.emissiveTexture, emission, {});
}

uint MaterialMaker::add(const Material& material) {
    scene_.materials.push_back(material);
    return static_cast<uint>(scene_.materials.size() - 1);
}

/// A base with reflections, or metal, or a texture's choice of both, on both sides.
uint MaterialMaker::add_opaque(const Surface& surface) {
    if (surface.is_diffuse()) {
        Material base = diffuse_material({1, 1, 1});
        base.reflectance = surface.color;
        return add_two_sided(scene_, base);
    }
    Material material = principled_material(scene_, surface.index);
    material.reflectance = surface.color;
    material.metallic = surface.metallic;
    material.roughness = surface.roughness;
    return add_two_sided(scene_, material);
}

uint MaterialMaker::add_glass(const Surface& surface) {
    const double index = surface.index > 1.001 ? surface.index : kUsualIndex;
    Material glass = surface.is_thin ? thin_dielectric_material(index) : dielectric_material(index);
    glass.transmission = surface.color;
    if (surface.roughness.value.x > 0.0f && surface.is_thin) {
        approximate("rough panes of glass are rendered smooth");
    } else if (surface.roughness.texture >= 0) {
        approximate("textures of the roughness of glass are replaced by their means");
    }
    const float roughness = mean_value(scene_, surface.roughness).x;
    glass.roughness = parameter_of(surface.is_thin ? 0.0f : roughness * roughness);
    return add(glass);
}

uint MaterialMaker::make(const tinygltf::Material& source) {
    const Surface surface = surface_of(source);
    remark_what_is_left_out(source);
    uint made = surface.transmission >= 1.0f ? add_glass(surface) : add_opaque(surface);
    if (surface.transmission > 0.0f && surface.transmission < 1.0f) {
        made = add(blend_material(parameter_of(surface.transmission), made, add_glass(surface)));
    }
    if (source.normalTexture.index >= 0) {
        if (source.normalTexture.scale != 1.0) {
            approximate("the scale of normal maps is left out");
        }
        const Parameter normals = textured_by(plain_info(source.normalTexture), {1, 1, 1}, {.gamma = 1.0f});
        made = normals.texture < 0 ? made : add(normal_map_material(normals, made));
    }
    if (surface.opacity.texture >= 0 || surface.opacity.value.x < 1.0f) {
        made = add(mask_material(surface.opacity, made));
    }
    scene_.materials[made].emission = emission_of(source);
    return made;
}

PlacedMaterial MaterialMaker::material(int index) {
    const auto [entry, is_new] = made_.try_emplace(index);
    if (!is_new) {
        return entry->second;
    }
    if (index < 0) {
        notes_.remark(file_.path, 0, "surfaces without a material are grey");
        entry->second.index = add_two_sided(scene_, diffuse_material({0.5f, 0.5f, 0.5f}));
        return entry->second;
    }
    const tinygltf::Material& source = file_.at(file_.model.materials, index, "material", "a mesh");
    entry->second.index = make(source);
    entry->second.texture_set = texture_set_of(source.pbrMetallicRoughness.baseColorTexture);
    return entry->second;
}

}  // namespace nearlight::core::gltf
