// SPDX-License-Identifier: Apache-2.0
#include "host/image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "host/base/math.h"
#include "host/image/color.h"
#include "host/image/flip.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::string channel_name(const std::string& layer, char component) {
    return layer.empty() ? std::string(1, component) : layer + "." + component;
}

/// The channels of a layer: red, green and blue, or what else the picture has under this name, such as A.
std::vector<std::string> layer_channels(const Image& image, const std::string& layer) {
    const std::vector<std::string> colors{channel_name(layer, 'R'), channel_name(layer, 'G'),
                                          channel_name(layer, 'B')};
    std::vector<std::string> others;
    for (const std::string& channel : image.channels) {
        if (!layer.empty() &&
            (channel == layer || (channel.starts_with(layer + ".") &&
                                  channel.find('.', layer.size() + 1) == std::string::npos))) {
            others.push_back(channel);
        }
    }
    const bool has_others = !others.empty() && others.size() <= 3;
    return has_others && !has_color_layer(image, layer) ? others : colors;
}

/// The values of one to three channels; missing ones are 0.
std::vector<Vec3> pixels_of(const Image& image, const std::vector<std::string>& channels, const char* which) {
    std::vector<std::size_t> indices;
    for (const std::string& name : channels) {
        const int index = image.find_channel(name);
        if (index < 0) {
            throw Error(ErrorKind::file,
                        std::string("the ") + which + " picture has no channel '" + name + "'");
        }
        indices.push_back(static_cast<std::size_t>(index));
    }
    std::vector<Vec3> pixels(image.pixel_count());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float* const values = image.values.data() + i * image.channel_count();
        const auto value = [&](std::size_t c) { return c < indices.size() ? values[indices[c]] : 0.0f; };
        pixels[i] = {value(0), value(1), value(2)};
    }
    return pixels;
}

/// One layer of two pictures of the same size.
struct Pair {
    std::size_t channel_count = 0;
    std::vector<Vec3> a;
    std::vector<Vec3> b;
    std::vector<bool> usable;  ///< finite in both pictures; all other pixels are black in both
    std::size_t usable_count = 0;
};

Pair pair_of(const Image& a, const Image& b, const std::string& layer) {
    if (a.width != b.width || a.height != b.height) {
        throw Error(ErrorKind::file, "pictures of " + std::to_string(a.width) + "x" +
                                         std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                                         std::to_string(b.height) + " pixels cannot be compared");
    }
    const std::vector<std::string> channels = layer_channels(a, layer);
    Pair pair{channels.size(), pixels_of(a, channels, "first"), pixels_of(b, channels, "second"), {}, 0};
    pair.usable.resize(pair.a.size());
    for (std::size_t i = 0; i < pair.a.size(); ++i) {
        pair.usable[i] = is_finite(pair.a[i]) && is_finite(pair.b[i]);
        if (pair.usable[i]) {
            ++pair.usable_count;
        } else {
            pair.a[i] = pair.b[i] = Vec3{0, 0, 0};
        }
    }
    return pair;
}

double luminance_of(Vec3 c) {
    return static_cast<double>(luminance(c));
}

double ratio(double numerator, double denominator) {
    if (denominator != 0.0) {
        return numerator / denominator;
    }
    return numerator == 0.0 ? 1.0 : std::numeric_limits<double>::infinity();
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The FLIP error of each pixel of pictures that are shown with their values multiplied by `scale`.
std::vector<float> flip_of(const Image& a, Pair pair, float scale) {
    for (std::vector<Vec3>* const pixels : {&pair.a, &pair.b}) {
        std::ranges::transform(*pixels, pixels->begin(), [scale](Vec3 color) { return color * scale; });
    }
    return flip_error(a.width, a.height, pair.a, pair.b);
}

/// The mean FLIP error of the pixels that can be compared.
double mean_flip(const Image& a, const Pair& pair, float scale) {
    const std::vector<float> flip = flip_of(a, pair, scale);
    double sum = 0.0;
    for (std::size_t i = 0; i < flip.size(); ++i) {
        sum += pair.usable[i] ? static_cast<double>(flip[i]) : 0.0;
    }
    return sum / static_cast<double>(pair.usable_count);
}

/// The colour (sRGB) of an error from 0 to 1: dark violet through red to pale yellow, in equal steps of
/// lightness.
Vec3 map_color(float error) {
    constexpr std::array<Vec3, 6> kStops{{{0.00f, 0.00f, 0.02f},
                                          {0.23f, 0.06f, 0.44f},
                                          {0.55f, 0.16f, 0.51f},
                                          {0.87f, 0.29f, 0.41f},
                                          {0.99f, 0.62f, 0.43f},
                                          {0.99f, 0.99f, 0.75f}}};
    const float position = std::clamp(error, 0.0f, 1.0f) * static_cast<float>(kStops.size() - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(position), kStops.size() - 2);
    const float weight = position - static_cast<float>(index);
    return kStops[index] * (1.0f - weight) + kStops[index + 1] * weight;
}

}  // namespace

bool has_color_layer(const Image& image, const std::string& layer) {
    return image.find_channel(channel_name(layer, 'R')) >= 0 &&
           image.find_channel(channel_name(layer, 'G')) >= 0 &&
           image.find_channel(channel_name(layer, 'B')) >= 0;
}

std::vector<std::string> color_layers(const Image& image) {
    std::vector<std::string> layers;
    for (const std::string& channel : image.channels) {
        const bool is_red = channel == "R" || channel.ends_with(".R");
        const std::string layer = channel.size() > 2 && is_red ? channel.substr(0, channel.size() - 2) : "";
        if (is_red && has_color_layer(image, layer)) {
            layers.push_back(layer);
        }
    }
    return layers;
}

ImageDifference compare_images(const Image& a, const Image& b, const std::string& layer, float scale) {
    const Pair pair = pair_of(a, b, layer);
    ImageDifference result;
    result.non_finite = pair.a.size() - pair.usable_count;
    if (pair.usable_count == 0) {
        result.rmse = result.relative_mse = result.mean_ratio = result.flip = kNone;
        return result;
    }
    double luminance_a = 0.0;
    double luminance_b = 0.0;
    for (std::size_t i = 0; i < pair.a.size(); ++i) {
        if (!pair.usable[i]) {
            continue;
        }
        const std::array<std::array<float, 2>, 3> components{
            {{pair.a[i].x, pair.b[i].x}, {pair.a[i].y, pair.b[i].y}, {pair.a[i].z, pair.b[i].z}}};
        for (const auto& [value, reference] : components) {
            const double squared = std::pow(static_cast<double>(value) - static_cast<double>(reference), 2);
            result.rmse += squared;
            result.relative_mse += squared / (std::pow(static_cast<double>(reference), 2) + 0.01);
        }
        luminance_a += luminance_of(pair.a[i]);
        luminance_b += luminance_of(pair.b[i]);
    }
    const auto count = static_cast<double>(pair.usable_count * pair.channel_count);
    result.rmse = std::sqrt(result.rmse / count);
    result.relative_mse /= count;
    const bool is_color = has_color_layer(a, layer);
    result.mean_ratio = is_color || pair.channel_count == 1 ? ratio(luminance_a, luminance_b) : kNone;
    result.flip = is_color ? mean_flip(a, pair, scale) : kNone;
    return result;
}

Image flip_map(const Image& a, const Image& b, const std::string& layer, float scale) {
    const Pair pair = pair_of(a, b, layer);
    if (!has_color_layer(a, layer)) {
        throw Error(ErrorKind::file, "layer '" + layer +
                                         "' is not one of colours, so that FLIP has no map of it; name one "
                                         "that has the channels R, G and B first");
    }
    const std::vector<float> flip = flip_of(a, pair, scale);
    Image map = make_image(a.width, a.height, {"R", "G", "B"});
    for (std::size_t i = 0; i < flip.size(); ++i) {
        const Vec3 color = map_color(flip[i]);
        map.values[3 * i] = srgb_to_linear(color.x);
        map.values[3 * i + 1] = srgb_to_linear(color.y);
        map.values[3 * i + 2] = srgb_to_linear(color.z);
    }
    return map;
}

}  // namespace nearlight::core
