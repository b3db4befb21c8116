// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture_loader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/half.h"
#include "host/image/image_io.h"
#include "host/scene/material_model.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// A number that textures can hold.
float tame(float value, bool is_signed) {
    if (std::isnan(value)) {
        return 0.0f;
    }
    return std::clamp(value, is_signed ? -kMaxHalf : 0.0f, kMaxHalf);
}

/// Appends two words of half floats for each texel. Returns how many texels have numbers that textures cannot
/// hold.
std::size_t pack_halves(const TexelReader& reader, std::size_t count, bool is_signed,
                        std::vector<std::uint32_t>& words) {
    words.reserve(2 * count);
    std::size_t tamed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 3> halves{};
        bool is_tame = true;
        const std::array<float, 3> rgb = reader.linear(i);
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = tame(rgb[c], is_signed);
            is_tame = is_tame && value == rgb[c];
            halves[c] = float_to_half(value);
        }
        tamed += is_tame ? 0 : 1;
        words.push_back(halves[0] | (halves[1] << 16u));
        words.push_back(halves[2] | 0x3c000000u);  // alpha is 1
    }
    return tamed;
}

}  // namespace

bool TextureLoader::can_read(const ImageSource& image) {
    try {
        reader_.read(image);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::file) {
            throw;
        }
        return false;
    }
    return true;
}

int TextureLoader::load(const ImageSource& image, const TexelRule& rule, const std::filesystem::path& file,
                        int line, std::string_view becomes) {
    const auto [entry, is_new] =
        loaded_.try_emplace({image.file.lexically_normal(), image.start(), rule}, -1);
    if (!is_new) {
        return entry->second;
    }
    const Image* pixels = nullptr;
    try {
        pixels = &reader_.read(image);
    } catch (const Error& error) {
        note_unreadable_texture(error, file, line, notes_, becomes);
        return -1;
    }
    entry->second = add(*pixels, image.file.filename().string(), rule, file, line);
    return entry->second;
}

int TextureLoader::add(const Image& image, const std::string& name, const TexelRule& rule,
                       const std::filesystem::path& file, int line) {
    const TexelReader reader(image, rule);
    TextureImage texture{name, image.width, image.height, reader.byte_format(), {}};
    if (auto bytes = reader.bytes()) {
        texture.words = std::move(*bytes);
    } else {
        texture.format = NEARLIGHT_TEXELS_HALF;
        const std::size_t tamed = pack_halves(reader, image.pixel_count(), rule.is_signed, texture.words);
        if (tamed > 0) {
            notes_.approximation(
                file, line,
                std::to_string(tamed) + " texels of '" + name +
                    "' are not finite, negative or above 65504; they are replaced by 0 or the limit");
        }
    }
    scene_.images.push_back(std::move(texture));
    return static_cast<int>(scene_.images.size() - 1);
}

void note_unreadable_texture(const Error& error, const std::filesystem::path& file, int line, NoteSink& notes,
                             std::string_view becomes) {
    if (error.kind() != ErrorKind::file) {
        throw error;
    }
    notes.approximation(file, line,
                        "texture is " + std::string(becomes) + " because it cannot be read: " + error.what());
}

SceneTexture plain_texture(int image) {
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_BITMAP;
    texture.parameters.u_scale = 1.0f;
    texture.parameters.v_scale = 1.0f;
    texture.parameters.color0 = texture.parameters.color1 = parameter_of(1.0f);
    texture.image = image;
    return texture;
}

SceneTexture vertex_color_texture() {
    SceneTexture texture = plain_texture(-1);
    texture.parameters.kind = NEARLIGHT_TEXTURE_VERTEX_COLOR;
    return texture;
}

int add_texture(Scene& scene, const SceneTexture& texture) {
    scene.textures.push_back(texture);
    return static_cast<int>(scene.textures.size() - 1);
}

EnvironmentLight load_environment(const std::filesystem::path& file, float scale, float gamma,
                                  std::size_t& bad_pixels) {
    const Image image = gamma > 0.0f ? read_image(file) : read_linear_image(file);
    EnvironmentLight light;
    light.width = image.width;
    light.height = image.height;
    bad_pixels = 0;
    const std::size_t count = image.pixel_count();
    light.radiance.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 3> rgb = rgb_at(image, i);
        bool is_bad = false;
        for (float& value : rgb) {
            value = (gamma > 0.0f ? std::pow(value, gamma) : value) * scale;
            if (!(value >= 0.0f && std::isfinite(value))) {
                is_bad = true;
                value = 0.0f;
            }
        }
        bad_pixels += is_bad ? 1 : 0;
        light.radiance.push_back({rgb[0], rgb[1], rgb[2]});
    }
    return light;
}

}  // namespace nearlight::core
