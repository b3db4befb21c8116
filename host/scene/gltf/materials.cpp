// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/image/color.h"
#include "host/image/image_io.h"
#include "host/scene/material_model.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// GGX's α, above which coats and metals are rendered matt. What they reflect is a blur, and would cost rays
/// that end all over the room. Point lights, which the camera sees in no lobe, would leave metals black.
constexpr float kMaxLobeAlpha = 0.2f;
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

/// The mean of the first three channels, or of the only one.
Vec3 mean_numbers(const Image& image) {
    const std::size_t channels = image.channel_count();
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < image.values.size(); i += channels) {
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += static_cast<double>(image.values[i + (channels < 3 ? 0 : c)]);
        }
    }
    const double count = static_cast<double>(std::max<std::size_t>(image.values.size() / channels, 1));
    return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
            static_cast<float>(sum[2] / count)};
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

}  // namespace

/// The properties that decide which material a glTF material becomes.
struct MaterialMaker::Surface {
    Vec3 color{1, 1, 1};  ///< base colour without the texture
    float opacity = 1;
    float metallic = 1;
    float roughness = 1;  ///< perceptual: the square root of GGX's α
    double index = kUsualIndex;
    Vec3 specular{1, 1, 1};
    bool transmits = false;
    bool is_thin = true;

    [[nodiscard]] float alpha() const { return std::clamp(roughness * roughness, 0.0f, 1.0f); }
};

void MaterialMaker::approximate(const std::string& what) {
    notes_.approximation(file_.path, 0, what);
}

const tinygltf::Image* MaterialMaker::image_of(const tinygltf::TextureInfo& info) const {
    if (info.index < 0) {
        return nullptr;
    }
    const tinygltf::Texture& texture = file_.at(file_.model.textures, info.index, "texture", "a material");
    return texture.source < 0 ? nullptr : &file_.at(file_.model.images, texture.source, "image", "a texture");
}

int MaterialMaker::load_colors(const tinygltf::Image& image) {
    if (!image.uri.empty()) {
        return textures_.load(file_.path.parent_path() / decoded_uri(image.uri), false, file_.path, 0);
    }
    try {
        return textures_.add(read_pixels(file_, image), name_of(image), false);
    } catch (const Error& error) {
        throw_unless_file(error);
        notes_.approximation(
            file_.path, 0,
            std::string("texture is replaced by mid-grey because it cannot be read: ") + error.what());
        return -1;
    }
}

/// Adds a texture, and returns its index into Scene::textures, or −1.
int MaterialMaker::add_texture(const tinygltf::TextureInfo& info) {
    const tinygltf::Image* const image = image_of(info);
    if (image == nullptr) {
        return -1;
    }
    const auto [entry, is_new] = colors_.try_emplace(image, -1);
    if (is_new) {
        entry->second = load_colors(*image);
    }
    if (entry->second < 0) {
        return -1;
    }
    SceneTexture texture = plain_texture(entry->second);
    apply_transform(info, texture.parameters);
    scene_.textures.push_back(texture);
    return static_cast<int>(scene_.textures.size() - 1);
}

/// The mean of the numbers in a texture's file; empty if there is no such texture.
std::optional<Vec3> MaterialMaker::mean_of(const tinygltf::TextureInfo& info) {
    const tinygltf::Image* const image = image_of(info);
    if (image == nullptr) {
        return std::nullopt;
    }
    const auto [entry, is_new] = means_.try_emplace(image);
    if (is_new) {
        try {
            entry->second = mean_numbers(read_pixels(file_, *image));
        } catch (const Error& error) {
            throw_unless_file(error);
            notes_.approximation(file_.path, 0, std::string("a texture is left out: ") + error.what());
        }
    }
    return entry->second;
}

MaterialMaker::Surface MaterialMaker::surface_of(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Surface surface;
    surface.color = clamped(to_vec3(pbr.baseColorFactor, {1, 1, 1}));
    surface.opacity = pbr.baseColorFactor.size() > 3 ? static_cast<float>(pbr.baseColorFactor[3]) : 1.0f;
    surface.metallic = static_cast<float>(pbr.metallicFactor);
    surface.roughness = static_cast<float>(pbr.roughnessFactor);
    if (const std::optional<Vec3> mean = mean_of(pbr.metallicRoughnessTexture)) {
        surface.roughness *= mean->y;
        surface.metallic *= mean->z;
        approximate("textures of roughness and metalness are replaced by their means");
    }
    surface.index = number_of(source.extensions, "KHR_materials_ior", "ior", kUsualIndex);
    const double specular = number_of(source.extensions, "KHR_materials_specular", "specularFactor", 1);
    surface.specular =
        clamped(static_cast<float>(specular) *
                color_of(source.extensions, "KHR_materials_specular", "specularColorFactor", {1, 1, 1}));
    surface.transmits =
        number_of(source.extensions, "KHR_materials_transmission", "transmissionFactor", 0) > 0.5;
    surface.is_thin = number_of(source.extensions, "KHR_materials_volume", "thicknessFactor", 0) <= 0;
    if (source.alphaMode == "BLEND" && surface.opacity < 0.5f && !surface.transmits) {
        approximate("blended surfaces are rendered as thin panes of glass");
        surface.transmits = true;
    }
    return surface;
}

void MaterialMaker::remark_what_is_left_out(const tinygltf::Material& source) {
    if (source.normalTexture.index >= 0) {
        approximate("normal maps are left out");
    }
    if (source.alphaMode == "MASK" ||
        (source.alphaMode == "BLEND" && source.pbrMetallicRoughness.baseColorTexture.index >= 0)) {
        approximate("holes made by the alpha of textures are filled");
    }
    for (const char* extension : {"KHR_materials_clearcoat", "KHR_materials_sheen"}) {
        if (source.extensions.contains(extension)) {
            approximate(std::string(extension) + " is left out");
        }
    }
}

/// The emission as a radiance, because exporters write a strength rather than nits.
Vec3 MaterialMaker::emission_of(const tinygltf::Material& source) {
    const double strength =
        number_of(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    Vec3 emission = static_cast<float>(strength) * max(to_vec3(source.emissiveFactor, {0, 0, 0}), {0, 0, 0});
    if (!is_zero(emission) && source.emissiveTexture.index >= 0) {
        if (const std::optional<Vec3> mean = mean_of(source.emissiveTexture)) {
            approximate("textures of emitted light are replaced by their means");
            emission =
                emission * Vec3{srgb_to_linear(mean->x), srgb_to_linear(mean->y), srgb_to_linear(mean->z)};
        }
    }
    return emission;
}

/// Makes a Lambertian material, under a coat if `has_coat` is true.
Material MaterialMaker::make_base(const tinygltf::Material& source, const Surface& surface, bool has_coat) {
    Material material =
        has_coat ? coat_material(surface.color, surface.specular, surface.index, surface.alpha(), false)
                 : diffuse_material(surface.color);
    material.base_texture = add_texture(source.pbrMetallicRoughness.baseColorTexture);
    if (material.base_texture < 0 && source.pbrMetallicRoughness.baseColorTexture.index >= 0) {
        material.base = {0.5f, 0.5f, 0.5f};
    }
    return material;
}

Material MaterialMaker::make_metal(const tinygltf::Material& source, const Surface& surface) {
    Vec3 tint = surface.color;
    if (const int texture = add_texture(source.pbrMetallicRoughness.baseColorTexture); texture >= 0) {
        approximate("colour textures of smooth metals are replaced by their means");
        const int image = scene_.textures[static_cast<std::size_t>(texture)].image;
        tint = tint * mean_color(scene_.images[static_cast<std::size_t>(image)]);
    }
    return conductor_material({0, 0, 0}, {1, 1, 1}, tint, surface.alpha());
}

Material MaterialMaker::make(const tinygltf::Material& source) {
    const Surface surface = surface_of(source);
    remark_what_is_left_out(source);
    const bool is_metal = surface.metallic > 0.5f;
    const bool reflects = is_metal || (!is_zero(surface.specular) && surface.index > 1 &&
                                       !source.extensions.contains("KHR_materials_unlit"));
    const bool is_smooth = surface.alpha() <= kMaxLobeAlpha;
    const bool is_even = !is_metal && surface.alpha() >= 1;
    if (reflects && !is_smooth && !is_even && !surface.transmits) {
        approximate("rough reflections are rendered diffuse");
    }
    Material material;
    if (surface.transmits) {
        material = glass_material(surface.index > 1 ? surface.index : kUsualIndex, surface.is_thin);
        material.transmission = surface.color;
    } else if (is_metal && is_smooth) {
        material = make_metal(source, surface);
    } else {
        material = make_base(source, surface, reflects && is_smooth);
    }
    material.emission = emission_of(source);
    if (!is_finite(material.emission)) {
        file_.fail("material '" + source.name + "' emits light that is not finite");
    }
    material.flags |= NEARLIGHT_MATERIAL_TWO_SIDED;
    return material;
}

PlacedMaterial MaterialMaker::material(int index) {
    const auto [entry, is_new] = made_.try_emplace(index);
    if (!is_new) {
        return entry->second;
    }
    Material made = diffuse_material({0.5f, 0.5f, 0.5f});
    made.flags |= NEARLIGHT_MATERIAL_TWO_SIDED;
    if (index < 0) {
        notes_.remark(file_.path, 0, "surfaces without a material are grey");
    } else {
        const tinygltf::Material& source = file_.at(file_.model.materials, index, "material", "a mesh");
        made = make(source);
        const tinygltf::TextureInfo& info = source.pbrMetallicRoughness.baseColorTexture;
        entry->second.texture_set =
            index_of(info.extensions, "KHR_texture_transform", "texCoord", info.texCoord);
    }
    entry->second.index = static_cast<uint>(scene_.materials.size());
    scene_.materials.push_back(made);
    return entry->second;
}

}  // namespace nearlight::core::gltf
