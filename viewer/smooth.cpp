// SPDX-License-Identifier: Apache-2.0
#include "viewer/smooth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "viewer/channels.h"
#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

/// Normals of one surface agree at least this well.
constexpr float kMinCosine = 0.9f;
/// Depths of one surface differ at most by this part.
constexpr float kMaxDepthStep = 0.04f;
/// Surfaces that reflect less of a colour are left as they are, because division by their albedo says
/// nothing.
constexpr float kMinAlbedo = 0.01f;

/// What decides which pixels show the same surface, and the light that falls on it.
struct Texel {
    Vec3 light{};
    Vec3 normal{};
    float depth = 0.0f;  ///< 0: left as it is
};

Vec3 load(const float* channels) {
    return {channels[0], channels[1], channels[2]};
}

bool show_same_surface(const Texel& a, const Texel& b) {
    return b.depth > 0.0f && std::abs(a.depth - b.depth) <= kMaxDepthStep * a.depth &&
           dot(a.normal, b.normal) >= kMinCosine;
}

/// Averages along a row or a column, `length` pixels that lie `stride` apart, over `side` of them at a time.
void average_line(const Texel* line, std::vector<Vec3>& light, std::size_t stride, int length, int side) {
    for (int i = 0; i < length; ++i) {
        const Texel& here = line[static_cast<std::size_t>(i) * stride];
        Vec3 sum{};
        int count = 0;
        const int first = i - side / 2;
        for (int j = std::max(first, 0); j < std::min(first + side, length) && here.depth > 0.0f; ++j) {
            const Texel& there = line[static_cast<std::size_t>(j) * stride];
            if (show_same_surface(here, there)) {
                sum = sum + there.light;
                ++count;
            }
        }
        light[static_cast<std::size_t>(i)] =
            count > 0 ? sum * (1.0f / static_cast<float>(count)) : here.light;
    }
}

void average(std::vector<Texel>& texels, int width, int height, int side, bool along_rows) {
    const int lines = along_rows ? height : width;
    const int length = along_rows ? width : height;
    const auto stride = static_cast<std::size_t>(along_rows ? 1 : width);
    const auto line_step = static_cast<std::size_t>(along_rows ? width : 1);
    std::vector<Vec3> light(static_cast<std::size_t>(length));
    for (int line = 0; line < lines; ++line) {
        Texel* const first = texels.data() + static_cast<std::size_t>(line) * line_step;
        average_line(first, light, stride, length, side);
        for (std::size_t i = 0; i < light.size(); ++i) {
            first[i * stride].light = light[i];
        }
    }
}

/// Where the layers are in a picture.
struct Places {
    explicit Places(const Image& image)
        : beauty(channels_of(image, "beauty").first),
          indirect(channels_of(image, "indirect").first),
          albedo(channels_of(image, "albedo").first),
          normal(channels_of(image, "N").first),
          depth(channels_of(image, "depth").first) {}
    std::size_t beauty, indirect, albedo, normal, depth;
};

std::vector<Texel> texels_of(const Image& image, const Places& at) {
    std::vector<Texel> texels;
    texels.reserve(image.values.size() / image.channels.size());
    for (const float* pixel = image.values.data(); pixel != image.values.data() + image.values.size();
         pixel += image.channels.size()) {
        const Vec3 albedo = load(pixel + at.albedo);
        const Vec3 light = load(pixel + at.indirect);
        const bool is_known =
            std::min({albedo.x, albedo.y, albedo.z}) >= kMinAlbedo && std::isfinite(luminance(light));
        Texel texel{.light = light, .normal = load(pixel + at.normal)};
        if (is_known) {
            texel.light = {light.x / albedo.x, light.y / albedo.y, light.z / albedo.z};
            texel.depth = pixel[at.depth];
        }
        texels.push_back(texel);
    }
    return texels;
}

}  // namespace

void smooth_interleaved(Image& image, int side) {
    const Places at(image);
    std::vector<Texel> texels = texels_of(image, at);
    average(texels, image.width, image.height, side, true);
    average(texels, image.width, image.height, side, false);
    float* pixel = image.values.data();
    for (const Texel& texel : texels) {
        if (texel.depth > 0.0f) {
            const Vec3 indirect = texel.light * load(pixel + at.albedo);
            const Vec3 change = indirect - load(pixel + at.indirect);
            for (const auto& [channel, value] : {std::pair{0u, change.x}, {1u, change.y}, {2u, change.z}}) {
                pixel[at.indirect + channel] += value;
                pixel[at.beauty + channel] += value;
            }
        }
        pixel += image.channels.size();
    }
}

}  // namespace nearlight::viewer
