// SPDX-License-Identifier: Apache-2.0
#include "nearlight/image.h"

#include <algorithm>
#include <utility>

#include "host/base/words.h"
#include "host/image/exposure_meter.h"
#include "host/image/image_io.h"
#include "host/image/metrics.h"
#include "host/library/checks.h"
#include "nearlight/error.h"

namespace nearlight {
namespace {

std::string_view channel_part(std::string_view channel) {
    return channel.substr(channel.rfind('.') + 1);
}

/// Copies the channels with the indices `selected`, in that order.
Image select_channels(const Image& image, const std::vector<std::size_t>& selected) {
    Image result{.width = image.width, .height = image.height};
    for (const std::size_t channel : selected) {
        result.channels.emplace_back(channel_part(image.channels[channel]));
    }
    const std::size_t pixel_count = image.values.size() / image.channels.size();
    result.values.reserve(pixel_count * selected.size());
    for (std::size_t pixel = 0; pixel < pixel_count; ++pixel) {
        for (const std::size_t channel : selected) {
            result.values.push_back(image.values[pixel * image.channels.size() + channel]);
        }
    }
    return result;
}

Image public_image(core::Image image) {
    return {.width = image.width,
            .height = image.height,
            .channels = std::move(image.channels),
            .values = std::move(image.values)};
}

/// One layer of a picture, for the metrics. They blame files for what is missing, callers of the library have
/// none.
core::Image color_layer(const Image& image, std::string_view name, const char* which) {
    check_values(std::string("cannot compare the ") + which, image);
    Image chosen = layer(image, name);
    core::Image result{chosen.width, chosen.height, std::move(chosen.channels), std::move(chosen.values)};
    if (!core::has_color_layer(result, "")) {
        throw Error(ErrorKind::invalid_argument,
                    "the layer '" + std::string(name) + "' of the " + which + " has no channels R, G and B");
    }
    return result;
}

struct ColorLayers {
    core::Image image;
    core::Image reference;
};

ColorLayers color_layers_of(const Image& image, const Image& reference, std::string_view name) {
    if (image.width != reference.width || image.height != reference.height) {
        throw Error(ErrorKind::invalid_argument,
                    "pictures of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                        " and " + std::to_string(reference.width) + "x" + std::to_string(reference.height) +
                        " pixels cannot be compared");
    }
    return {color_layer(image, name, "picture"), color_layer(reference, name, "reference")};
}

}  // namespace

std::string_view layer_of(std::string_view channel) {
    return core::layer_of(channel);
}

std::vector<std::string> layer_names(const Image& image) {
    return core::layer_names(image.channels);
}

Image layer(const Image& image, std::string_view name) {
    std::vector<std::size_t> selected;
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        if (layer_of(image.channels[i]) == name) {
            selected.push_back(i);
        }
    }
    if (selected.empty()) {
        throw Error(ErrorKind::invalid_argument,
                    "the image has no layer '" + std::string(name) +
                        "'; there are: " + core::joined(layer_names(image), ", "));
    }
    return select_channels(image, selected);
}

void write_image(const std::filesystem::path& file, const Image& image, const WriteOptions& options) {
    check_values("cannot write '" + file.string() + "'", image);
    core::ImageWriter writer(file, image.width, image.height, image.channels,
                             {.metadata = {}, .exposure = options.exposure, .curve = options.tone_curve});
    writer.write_rows(image.values);
    writer.commit();
}

Vec3 tone_mapped(ToneCurve curve, Vec3 color) {
    const core::Vec3 mapped = core::apply_tone_curve(curve, {color.x, color.y, color.z});
    return {mapped.x, mapped.y, mapped.z};
}

float automatic_exposure(const Image& image) {
    return core::automatic_exposure(image.channels, image.values);
}

Image read_image(const std::filesystem::path& file) {
    return public_image(core::read_image(file));
}

Image read_linear_image(const std::filesystem::path& file) {
    return public_image(core::read_linear_image(file));
}

Difference diff(const Image& image, const Image& reference, std::string_view layer) {
    const ColorLayers layers = color_layers_of(image, reference, layer);
    const core::ImageDifference difference = core::compare_images(layers.image, layers.reference);
    return {.rmse = difference.rmse,
            .relative_mse = difference.relative_mse,
            .mean_ratio = difference.mean_ratio,
            .flip = difference.flip,
            .non_finite = difference.non_finite};
}

Image diff_map(const Image& image, const Image& reference, std::string_view layer) {
    const ColorLayers layers = color_layers_of(image, reference, layer);
    return public_image(core::flip_map(layers.image, layers.reference));
}

}  // namespace nearlight
