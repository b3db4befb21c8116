// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture_loader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/half.h"
#include "host/image/color.h"
#include "host/image/image_io.h"
#include "host/scene/material_model.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

bool holds_floats(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return extension == ".exr" || extension == ".hdr" || extension == ".pfm" || extension == ".rgbe";
}

// One or two channels are grey (and alpha); three or more are red, green, blue (and alpha).
std::array<float, 3> rgb_at(const Image& image, std::size_t pixel) {
    const std::size_t channels = image.channel_count();
    const float* p = image.values.data() + pixel * channels;
    return channels < 3 ? std::array<float, 3>{p[0], p[0], p[0]} : std::array<float, 3>{p[0], p[1], p[2]};
}

float channel_at(const Image& image, std::size_t pixel, int channel) {
    const std::size_t channels = image.channel_count();
    const float* p = image.values.data() + pixel * channels;
    if (channel == 3) {
        return channels == 2 || channels >= 4 ? p[channels == 2 ? 1 : 3] : 1.0f;
    }
    return channels < 3 ? p[0] : p[channel];
}

/// Whether the image has alpha, and not 1 everywhere.
bool is_transparent(const Image& image) {
    const std::size_t count = image.values.size() / image.channel_count();
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        if (channel_at(image, pixel, 3) != 1.0f) {
            return true;
        }
    }
    return false;
}

/// Turns the numbers of an image into texels.
class TexelReader {
  public:
    TexelReader(const Image& image, const TexelRule& rule, bool holds_floats)
        : image_(image),
          rule_(rule),
          channel_(rule.prefers_alpha && is_transparent(image) ? 3 : rule.channel),
          gamma_(channel_ >= 0 ? 1.0f : (rule.gamma > 0.0f || !holds_floats ? rule.gamma : 1.0f)) {}

    /// The format that keeps the image's numbers: 8 bits where all of them have that many.
    [[nodiscard]] uint format(bool holds_floats) const {
        const bool is_standard = gamma_ == 0.0f || gamma_ == 1.0f;
        if (holds_floats || !is_standard || !is_eight_bit()) {
            return NEARLIGHT_TEXELS_HALF;
        }
        return gamma_ == 1.0f ? NEARLIGHT_TEXELS_LINEAR8 : NEARLIGHT_TEXELS_SRGB8;
    }

    /// The numbers of the file that make the texel.
    [[nodiscard]] std::array<float, 3> source(std::size_t pixel) const {
        if (channel_ >= 0) {
            const float number = channel_at(image_, pixel, channel_);
            const float kept = rule_.is_inverse ? 1.0f - rule_.factor * number : number;
            return {kept, kept, kept};
        }
        std::array<float, 3> rgb = rgb_at(image_, pixel);
        if (rule_.times_alpha) {
            const float alpha = alpha_at(pixel);
            for (float& value : rgb) {
                value = alpha == 0.0f ? 0.0f : alpha == 1.0f ? value : encode(decode(value) * alpha);
            }
        }
        if (rule_.steepness_x != 1.0f || rule_.steepness_y != 1.0f) {
            rgb[0] = 0.5f + rule_.steepness_x * (rgb[0] - 0.5f);
            rgb[1] = 0.5f + rule_.steepness_y * (rgb[1] - 0.5f);
        }
        return rgb;
    }

    /// The texel, decoded.
    [[nodiscard]] std::array<float, 3> linear(std::size_t pixel) const {
        std::array<float, 3> rgb = source(pixel);
        for (float& value : rgb) {
            value = decode(value);
        }
        if (rule_.is_number && !is_grey(rgb)) {
            rgb.fill(luminance(Vec3{rgb[0], rgb[1], rgb[2]}));
        }
        return rgb;
    }

  private:
    static bool is_grey(const std::array<float, 3>& rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

    [[nodiscard]] float decode(float value) const {
        return gamma_ == 1.0f   ? value
               : gamma_ == 0.0f ? srgb_to_linear(value)
                                : std::pow(std::max(value, 0.0f), gamma_);
    }
    [[nodiscard]] float encode(float linear) const {
        return gamma_ == 1.0f   ? linear
               : gamma_ == 0.0f ? linear_to_srgb(linear)
                                : std::pow(std::max(linear, 0.0f), 1.0f / gamma_);
    }

    [[nodiscard]] float alpha_at(std::size_t pixel) const {
        const float alpha = channel_at(image_, pixel, 3);
        return rule_.alpha_cutoff > 0.0f ? (alpha >= rule_.alpha_cutoff ? 1.0f : 0.0f) : alpha;
    }

    [[nodiscard]] bool is_eight_bit() const {
        const std::size_t count = image_.values.size() / image_.channel_count();
        for (std::size_t i = 0; i < count; ++i) {
            const std::array<float, 3> rgb = source(i);
            if (rule_.is_number && !is_grey(rgb)) {
                return false;
            }
            for (const float value : rgb) {
                const float code = value * 255.0f;
                if (!(code >= 0.0f && code <= 255.0f && std::fabs(code - std::round(code)) < 1e-3f)) {
                    return false;
                }
            }
        }
        return true;
    }

    const Image& image_;
    const TexelRule& rule_;
    int channel_;  // −1: all
    float gamma_;  // 0: sRGB
};

std::uint32_t to_byte(float value) {
    return static_cast<std::uint32_t>(value * 255.0f + 0.5f);
}

std::uint32_t pack_bytes(const std::array<float, 3>& rgb) {
    return 0xff000000u | to_byte(rgb[0]) | (to_byte(rgb[1]) << 8u) | (to_byte(rgb[2]) << 16u);
}

/// A number that textures can hold.
float tame(float value, bool is_signed) {
    if (std::isnan(value)) {
        return 0.0f;
    }
    return std::clamp(value, is_signed ? -kMaxHalf : 0.0f, kMaxHalf);
}

}  // namespace

int TextureLoader::load(const std::filesystem::path& image, const TexelRule& rule,
                        const std::filesystem::path& file, int line) {
    const auto [entry, is_new] = loaded_.try_emplace({image.lexically_normal(), rule}, -1);
    if (!is_new) {
        return entry->second;
    }
    try {
        entry->second = add_texels(read_image(image), image.filename().string(), rule, holds_floats(image),
                                   {file, line, {}});
    } catch (const Error& error) {
        throw_unless_file(error);
        notes_.approximation(
            file, line,
            std::string("texture is replaced by mid-grey because it cannot be read: ") + error.what());
    }
    return entry->second;
}

int TextureLoader::add(const Image& image, const std::string& name, const TexelRule& rule,
                       const std::filesystem::path& file, int line) {
    return add_texels(image, name, rule, false, {file, line, {}});
}

int TextureLoader::add_texels(const Image& image, const std::string& name, const TexelRule& rule,
                              bool holds_floats, const Note& place) {
    const TexelReader reader(image, rule, holds_floats);
    TextureImage texture{name, image.width, image.height, reader.format(holds_floats), {}};
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const bool has_halves = texture.format == NEARLIGHT_TEXELS_HALF;
    texture.words.reserve(has_halves ? 2 * count : count);
    std::size_t tamed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!has_halves) {
            texture.words.push_back(pack_bytes(reader.source(i)));
            continue;
        }
        std::array<std::uint32_t, 3> halves{};
        bool is_tame = true;
        const std::array<float, 3> rgb = reader.linear(i);
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = tame(rgb[c], rule.is_signed);
            is_tame = is_tame && value == rgb[c];
            halves[c] = float_to_half(value);
        }
        tamed += is_tame ? 0 : 1;
        texture.words.push_back(halves[0] | (halves[1] << 16u));
        texture.words.push_back(halves[2] | 0x3c000000u);  // alpha is 1
    }
    if (tamed > 0) {
        notes_.approximation(
            place.file, place.line,
            std::to_string(tamed) + " texels of '" + name +
                "' are not finite, negative or above 65504; they are replaced by 0 or the limit");
    }
    scene_.images.push_back(std::move(texture));
    return static_cast<int>(scene_.images.size() - 1);
}

void throw_unless_file(const Error& error) {
    if (error.kind() != ErrorKind::file) {
        throw error;
    }
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

EnvironmentLight load_environment(const std::filesystem::path& file, float scale, std::size_t& bad_pixels) {
    const Image image = read_image(file);
    const bool linear = holds_floats(file);
    EnvironmentLight light;
    light.width = image.width;
    light.height = image.height;
    bad_pixels = 0;
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    light.radiance.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 3> rgb = rgb_at(image, i);
        bool is_bad = false;
        for (float& value : rgb) {
            value = (linear ? value : srgb_to_linear(value)) * scale;
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
