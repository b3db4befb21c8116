// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture_loader.h"

#include <array>
#include <cmath>

#include "host/image/color.h"
#include "host/image/image_io.h"
#include "host/scene/texture.h"
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

std::uint32_t to_byte(float value) {
    return std::isfinite(value) ? static_cast<std::uint32_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f)
                                : 0u;
}

TextureImage to_texture(const Image& image, const std::string& name, bool linear) {
    TextureImage texture{name, image.width, image.height, {}};
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    texture.texels.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t texel = 0xff000000u;
        const std::array<float, 3> rgb = rgb_at(image, i);
        for (std::size_t c = 0; c < 3; ++c) {
            texel |= to_byte(linear ? linear_to_srgb(rgb[c]) : rgb[c]) << (8 * c);
        }
        texture.texels.push_back(texel);
    }
    return texture;
}

}  // namespace

int TextureLoader::load(const std::filesystem::path& image, bool linear, const std::filesystem::path& file,
                        int line) {
    const auto [entry, is_new] = loaded_.try_emplace({image.lexically_normal(), linear}, -1);
    if (!is_new) {
        return entry->second;
    }
    try {
        entry->second = add(read_image(image), image.filename().string(), linear || holds_floats(image));
    } catch (const Error& error) {
        throw_unless_file(error);
        notes_.approximation(
            file, line,
            std::string("texture is replaced by mid-grey because it cannot be read: ") + error.what());
    }
    return entry->second;
}

int TextureLoader::add(const Image& image, const std::string& name, bool linear) {
    scene_.images.push_back(to_texture(image, name, linear));
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
    texture.image = image;
    return texture;
}

Vec3 mean_color(const TextureImage& image) {
    const std::array<float, 256>& table = srgb_decode_table();
    std::array<double, 3> sum{};
    for (const std::uint32_t texel : image.texels) {
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += table[(texel >> (8 * c)) & 255u];
        }
    }
    const double count = std::max<double>(1.0, static_cast<double>(image.texels.size()));
    return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
            static_cast<float>(sum[2] / count)};
}

EnvironmentLight load_environment(const std::filesystem::path& file, float scale) {
    const Image image = read_image(file);
    const bool linear = holds_floats(file);
    EnvironmentLight light;
    light.width = image.width;
    light.height = image.height;
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    light.radiance.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 3> rgb = rgb_at(image, i);
        for (float& value : rgb) {
            value = (linear ? value : srgb_to_linear(value)) * scale;
            value = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
        }
        light.radiance.push_back({rgb[0], rgb[1], rgb[2]});
    }
    return light;
}

}  // namespace nearlight::core
