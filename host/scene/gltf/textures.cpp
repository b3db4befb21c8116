// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/textures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "host/scene/material_model.h"
#include "host/scene/texture.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// What messages call an image that has no file of its own.
std::string name_of(const GltfFile& file, const tinygltf::Image& image) {
    const auto index = &image - file.model.images.data();
    const std::string name = image.name.empty() ? "" : " (" + image.name + ")";
    return file.path.string() + ", image " + std::to_string(index) + name +
           (image.bufferView >= 0 ? " in a buffer" : " in a data URI");
}

/// Where the image is read from. Calls fail() if its URI is empty or of a kind that is not read, or if it is
/// in a buffer view that does not exist.
ImageSource source_of(const GltfFile& file, const tinygltf::Image& image) {
    if (image.uri.starts_with("data:")) {  // those of other kinds have been decoded by now
        file.fail("its data URI is not of a kind that is read: " +
                  image.uri.substr(0, std::min(image.uri.find_first_of(";,"), std::size_t{40})));
    }
    if (!image.uri.empty()) {
        return {.file = file.path.parent_path() / decoded_uri(image.uri)};
    }
    if (image.bufferView < 0 && image.image.empty()) {
        file.fail("the URI of image " + std::to_string(&image - file.model.images.data()) + " is empty");
    }
    return {.file = name_of(file, image),
            .bytes = image.bufferView >= 0 ? bytes_of(file, image.bufferView)
                                           : std::as_bytes(std::span(image.image))};
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

void apply_sampler(const tinygltf::Sampler& sampler, Texture& texture) {
    texture.wrap_s = wrap_of(sampler.wrapS);
    texture.wrap_t = wrap_of(sampler.wrapT);
    texture.filter = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? NEARLIGHT_FILTER_NEAREST
                                                                          : NEARLIGHT_FILTER_BILINEAR;
}

bool are_placed_alike(const Texture& a, const Texture& b) {
    const auto numbers = [](const Texture& t) {
        return std::tuple(t.u_scale, t.u_shear, t.u_offset, t.v_shear, t.v_scale, t.v_offset, t.wrap_s,
                          t.wrap_t, t.filter);
    };
    return numbers(a) == numbers(b);
}

/// The index of the texture's image of the kind WebP, or −1.
int webp_of(const tinygltf::Texture& texture) {
    return index_of(texture.extensions, "EXT_texture_webp", "source", -1);
}

}  // namespace

int texture_set_of(const GltfFile& file, const tinygltf::TextureInfo& info) {
    const int set = index_of(info.extensions, "KHR_texture_transform", "texCoord", info.texCoord);
    if (set < 0) {
        file.fail("a texture asks for the set " + std::to_string(set) + " of texture coordinates");
    }
    return set;
}

TextureAxes texture_axes(const tinygltf::TextureInfo& info) {
    Texture t = plain_texture(0).parameters;
    apply_transform(info, t);
    const float side = t.u_scale * t.v_scale < t.u_shear * t.v_shear ? -1.0f : 1.0f;
    const float l = std::hypot(t.v_scale, t.v_shear);
    if (!(l > 0.0f)) {
        return {};
    }
    // The first column of the inverse matrix.
    const std::array<float, 2> u{side * t.v_scale / l, -side * t.v_shear / l};
    return {.u = u, .v = {-side * u[1], side * u[0]}};
}

/// The images that textures show, in the order of the textures. What is wrong with one is told when a
/// material asks for it.
std::vector<ImageSource> TextureMaker::shown_images() const {
    std::vector<ImageSource> sources;
    for (const tinygltf::Texture& texture : file_.model.textures) {
        const int webp = webp_of(texture);
        const auto index = static_cast<std::size_t>(webp >= 0 ? webp : texture.source);
        if (index >= file_.model.images.size()) {
            continue;
        }
        try {
            sources.push_back(source_of(file_, file_.model.images[index]));
        } catch (const Error&) {
            continue;
        }
    }
    return sources;
}

int TextureMaker::load_image(const tinygltf::Image& image, const TexelRule& rule) {
    std::optional<ImageSource> source;
    try {
        source = source_of(file_, image);
    } catch (const Error& error) {
        note_unreadable_texture(error, file_.path, 0, notes_);
        return -1;
    }
    return loader_.load(*source, rule, file_.path, 0);
}

bool TextureMaker::can_read(int image) {
    const auto index = static_cast<std::size_t>(image);
    if (index >= file_.model.images.size()) {
        return true;  // the error is told by whoever asks for the image
    }
    const auto [entry, is_new] = readable_.try_emplace(image, true);
    if (!is_new) {
        return entry->second;
    }
    try {
        entry->second = loader_.can_read(source_of(file_, file_.model.images[index]));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::file) {
            throw;
        }
        entry->second = false;
    }
    return entry->second;
}

/// Builds may lack what it takes to read WebP, and files that do not require it have another image beside it.
int TextureMaker::readable_image_of(const tinygltf::Texture& texture) {
    const int webp = webp_of(texture);
    if (webp < 0 || texture.source < 0 || can_read(webp)) {
        return webp >= 0 ? webp : texture.source;
    }
    notes_.remark(file_.path, 0, "EXT_texture_webp: what cannot be read is replaced by the image beside it");
    return texture.source;
}

/// The index of the texture's image, −1 if it has none, or −2 with a note if it has only one of a format that
/// is not read.
int TextureMaker::image_of(const tinygltf::Texture& texture) {
    const int readable = readable_image_of(texture);
    if (readable >= 0) {
        return readable;
    }
    for (const auto& [name, extension] : texture.extensions) {
        if (extension.Has("source")) {
            notes_.approximation(file_.path, 0,
                                 "texture is replaced by mid-grey because " + name + " is not supported");
            return -2;
        }
    }
    return -1;
}

/// How and where the texture shows its image.
void TextureMaker::place(const tinygltf::TextureInfo& info, const tinygltf::Texture& source,
                         Texture& texture) const {
    apply_transform(info, texture);
    if (source.sampler >= 0) {
        apply_sampler(file_.at(file_.model.samplers, source.sampler, "sampler", "a texture"), texture);
    }
}

Parameter TextureMaker::textured_by(const tinygltf::TextureInfo& info, Vec3 value, const TexelRule& rule,
                                    const TextureSets& sets, uint flags, float cutoff) {
    if (info.index < 0 || is_zero(value)) {
        return parameter_of(value);
    }
    const tinygltf::Texture& source = file_.at(file_.model.textures, info.index, "texture", "a material");
    const int image = image_of(source);
    if (image < 0) {
        return parameter_of(image == -1 ? value : value * 0.5f);
    }
    const auto [entry, is_new] = images_.try_emplace({image, rule}, -1);
    if (is_new) {
        entry->second = load_image(file_.at(file_.model.images, image, "image", "a texture"), rule);
    }
    if (entry->second < 0) {
        return parameter_of(value * 0.5f);
    }
    SceneTexture texture = plain_texture(entry->second);
    place(info, source, texture.parameters);
    const bool is_second = texture_set_of(file_, info) != sets.first;
    texture.parameters.flags = flags | (is_second ? NEARLIGHT_TEXTURE_SECOND_UV : 0u);
    texture.parameters.cutoff = cutoff;
    return {value, add_texture(scene_, texture)};
}

Parameter TextureMaker::vertex_color(Vec3 value) {
    if (vertex_color_ < 0) {
        vertex_color_ = add_texture(scene_, vertex_color_texture());
    }
    return {value, vertex_color_};
}

/// Between the middles of a black and a white texel, which lie at ¼ and ¾, the bilinear filter rises as the
/// coordinate does.
Parameter TextureMaker::vertex_number(float cutoff) {
    if (ramp_ < 0) {
        scene_.images.push_back({"numbers of vertices", 2, 1, NEARLIGHT_TEXELS_LINEAR8, {0xff000000u, ~0u}});
        ramp_ = static_cast<int>(scene_.images.size() - 1);
    }
    SceneTexture texture = plain_texture(ramp_);
    texture.parameters.u_scale = 0.5f;
    texture.parameters.u_offset = 0.25f;
    texture.parameters.wrap_s = texture.parameters.wrap_t = NEARLIGHT_WRAP_CLAMP;
    texture.parameters.flags = NEARLIGHT_TEXTURE_SECOND_UV;
    texture.parameters.cutoff = cutoff;
    return textured(add_texture(scene_, texture));
}

Vec3 TextureMaker::mean(const Parameter& parameter) const {
    return mean_value(scene_, parameter);
}

void TextureMaker::visit_texels(const Parameter& parameter, const std::function<void(Vec3)>& visit) const {
    const int image =
        parameter.texture < 0 ? -1 : scene_.textures[static_cast<std::size_t>(parameter.texture)].image;
    if (image < 0) {
        visit(parameter.value);
        return;
    }
    const TextureImage& texels = scene_.images[static_cast<std::size_t>(image)];
    const std::size_t count =
        static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.height);
    for (std::size_t i = 0; i < count; ++i) {
        visit(parameter.value * texel_color(texels, i));
    }
}

bool TextureMaker::show_same(const tinygltf::TextureInfo& a, const tinygltf::TextureInfo& b) {
    const auto source = [&](const tinygltf::TextureInfo& info) {
        const auto index = static_cast<std::size_t>(info.index);
        const bool is_there = info.index >= 0 && index < file_.model.textures.size();
        return is_there ? &file_.model.textures[index] : nullptr;
    };
    const tinygltf::Texture* const source_a = source(a);
    const tinygltf::Texture* const source_b = source(b);
    if (source_a == nullptr || source_b == nullptr) {
        return false;
    }
    const int image = readable_image_of(*source_a);
    if (image < 0 || image != readable_image_of(*source_b) ||
        texture_set_of(file_, a) != texture_set_of(file_, b)) {
        return false;
    }
    Texture place_a = plain_texture(0).parameters;
    Texture place_b = place_a;
    place(a, *source_a, place_a);
    place(b, *source_b, place_b);
    return are_placed_alike(place_a, place_b);
}

}  // namespace nearlight::core::gltf
