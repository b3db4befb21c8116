// SPDX-License-Identifier: Apache-2.0
#include "host/compare/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host/base/division.h"
#include "host/image/color.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

std::size_t pixel_count(const Image& picture) {
    return static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
}

Vec3 mixed(Vec3 a, Vec3 b, float weight) {
    return a * (1.0f - weight) + b * weight;
}

bool overlap(const Crop& a, const Crop& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Table of the sums over all (width + 1) × (height + 1) rectangles that begin at the top left corner.
class SummedAreas {
  public:
    SummedAreas(std::span<const double> values, int width, int height)
        : stride_(static_cast<std::size_t>(width) + 1),
          sums_(stride_ * (static_cast<std::size_t>(height) + 1)) {
        for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
            double row = 0.0;
            for (std::size_t x = 0; x + 1 < stride_; ++x) {
                row += values[y * (stride_ - 1) + x];
                sums_[(y + 1) * stride_ + x + 1] = sums_[y * stride_ + x + 1] + row;
            }
        }
    }
    [[nodiscard]] double over(const Crop& crop) const {
        return at(crop.x + crop.width, crop.y + crop.height) - at(crop.x, crop.y + crop.height) -
               at(crop.x + crop.width, crop.y) + at(crop.x, crop.y);
    }

  private:
    [[nodiscard]] double at(int x, int y) const {
        return sums_[static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x)];
    }
    std::size_t stride_;
    std::vector<double> sums_;
};

}  // namespace

Image make_picture(int width, int height) {
    return make_image(width, height, {"R", "G", "B"});
}

Image color_layer(const Image& image, const std::string& layer) {
    std::array<std::size_t, 3> indices{};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string name = (layer.empty() ? "" : layer + ".") + "RGB"[c];
        const int index = image.find_channel(name);
        if (index < 0) {
            throw Error(ErrorKind::file, "the picture has no channel '" + name + "'");
        }
        indices[c] = static_cast<std::size_t>(index);
    }
    Image picture = make_picture(image.width, image.height);
    for (std::size_t i = 0; i < pixel_count(picture); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            picture.values[3 * i + c] = image.values[i * image.channel_count() + indices[c]];
        }
    }
    return picture;
}

std::vector<Vec3> pixels_of(const Image& picture) {
    std::vector<Vec3> pixels(pixel_count(picture));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = {picture.values[3 * i], picture.values[3 * i + 1], picture.values[3 * i + 2]};
    }
    return pixels;
}

Image scaled(Image picture, float factor) {
    for (float& value : picture.values) {
        value *= factor;
    }
    return picture;
}

Image cropped(const Image& picture, const Crop& crop) {
    return part_of(picture, crop.x, crop.y, crop.width, crop.height);
}

Image shrunk(const Image& picture, int max_width) {
    const int factor = std::min(divide_rounding_up(picture.width, max_width), picture.height);
    Image small = make_picture(picture.width / factor, picture.height / factor);
    for (int y = 0; y < small.height * factor; ++y) {
        for (int x = 0; x < small.width * factor; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                small.at(x / factor, y / factor, c) +=
                    picture.at(x, y, c) / static_cast<float>(factor * factor);
            }
        }
    }
    return small;
}

Image enlarged(const Image& picture, int factor) {
    Image large = make_picture(picture.width * factor, picture.height * factor);
    for (int y = 0; y < large.height; ++y) {
        for (int x = 0; x < large.width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                large.at(x, y, c) = picture.at(x / factor, y / factor, c);
            }
        }
    }
    return large;
}

float display_scale(const Image& picture) {
    std::vector<float> luminances;
    for (const Vec3 pixel : pixels_of(picture)) {
        luminances.push_back(is_finite(pixel) ? luminance(pixel) : 0.0f);
    }
    const auto bright = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() * 95 / 100);
    std::nth_element(luminances.begin(), bright, luminances.end());
    return *bright > 0.0f ? 0.7f / *bright : 1.0f;
}

Vec3 error_color(float error) {
    constexpr Vec3 kMissing{0.13f, 0.32f, 0.71f};
    constexpr Vec3 kRight{0.97f, 0.97f, 0.97f};
    constexpr Vec3 kTooMuch{0.75f, 0.10f, 0.13f};
    const float size = std::clamp(std::abs(error), 0.0f, 1.0f);
    return mixed(kRight, error < 0.0f ? kMissing : kTooMuch, size);
}

Image signed_error_map(const Image& picture, const Image& reference) {
    const std::vector<Vec3> a = pixels_of(picture);
    const std::vector<Vec3> b = pixels_of(reference);
    double mean = 0.0;
    for (const Vec3 pixel : b) {
        mean += static_cast<double>(luminance(pixel)) / static_cast<double>(b.size());
    }
    const float floor = 0.05f * static_cast<float>(mean);
    Image map = make_picture(picture.width, picture.height);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float denominator = luminance(b[i]) + floor;
        const float error = denominator > 0.0f ? (luminance(a[i]) - luminance(b[i])) / denominator : 0.0f;
        const Vec3 color = error_color(error / kErrorMapLimit);
        map.values[3 * i] = srgb_to_linear(color.x);
        map.values[3 * i + 1] = srgb_to_linear(color.y);
        map.values[3 * i + 2] = srgb_to_linear(color.z);
    }
    return map;
}

std::vector<Crop> hardest_crops(const Image& picture, const Image& reference, std::size_t count) {
    const int width = picture.width;
    const int height = picture.height;
    std::vector<double> squares(pixel_count(picture));
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        const double difference =
            static_cast<double>(picture.values[i]) - static_cast<double>(reference.values[i]);
        squares[i / 3] += difference * difference;
    }
    const SummedAreas sums(squares, width, height);
    std::vector<Crop> crops;
    while (crops.size() < count) {
        Crop best;
        double max_sum = -1.0;
        Crop crop{0, 0, std::max(1, width / 4), std::max(1, height / 4)};
        for (crop.y = 0; crop.y + crop.height <= height; ++crop.y) {
            for (crop.x = 0; crop.x + crop.width <= width; ++crop.x) {
                const bool free =
                    std::ranges::none_of(crops, [&](const Crop& other) { return overlap(crop, other); });
                if (free && sums.over(crop) > max_sum) {
                    max_sum = sums.over(crop);
                    best = crop;
                }
            }
        }
        if (max_sum < 0.0) {
            break;
        }
        crops.push_back(best);
    }
    return crops;
}

}  // namespace nearlight::core
