// SPDX-License-Identifier: Apache-2.0
#include "host/image/exposure_meter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "nearlight/error.h"

namespace nearlight::core {

void ExposureMeter::Light::add(Vec3 color) {
    const float y = luminance(color);
    if (is_finite(color) && y > 0.0f) {
        luminances.push_back(y);
        brightest.push_back(max_component(color));
    }
}

double ExposureMeter::Light::mean_log2() const {
    constexpr float kDarkest = 1.0f / 1024;  // part of the median, of what counts
    std::vector<float> sorted = luminances;
    const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, median);
    double sum = 0.0;
    std::size_t count = 0;
    for (const float y : luminances) {
        if (y >= kDarkest * *median) {
            sum += std::log2(static_cast<double>(y));
            ++count;
        }
    }
    return sum / static_cast<double>(count);
}

void ExposureMeter::add(Vec3 color, float depth, Vec3 albedo) {
    if (!(depth > 0.0f && std::isfinite(depth))) {
        background_.add(color);
        return;
    }
    constexpr float kUsualAlbedo = 0.4f;
    const float reflected = luminance(albedo);
    // Metals and dark gloss reflect more than their albedo says, so that it cannot tell the light on them.
    const float scale =
        reflected > 0.01f ? std::sqrt(kUsualAlbedo / std::clamp(reflected, 0.1f, 1.0f)) : 1.0f;
    surfaces_.add(scale * color);
}

float ExposureMeter::exposure() const {
    constexpr double kGrey = 0.25;       // the mean brightness that is wanted
    constexpr double kAlmostAll = 0.97;  // this share of the picture is to stay below kWhite
    constexpr double kWhite = 3.0;
    const Light& light = surfaces_.brightest.empty() ? background_ : surfaces_;
    std::vector<float> brightest = light.brightest;
    if (brightest.empty()) {
        return 0.0f;
    }
    const auto last = static_cast<std::ptrdiff_t>(kAlmostAll * static_cast<double>(brightest.size() - 1));
    std::nth_element(brightest.begin(), brightest.begin() + last, brightest.end());
    const double for_grey = std::log2(kGrey) - light.mean_log2();
    const double for_white =
        std::log2(kWhite / static_cast<double>(brightest[static_cast<std::size_t>(last)]));
    return static_cast<float>(std::clamp(std::min(for_grey, for_white), -60.0, 60.0));
}

float automatic_exposure(std::span<const std::string> channels, std::span<const float> values) {
    const std::size_t stride = channels.size();
    const auto place_of = [&](const char* channel) {
        return static_cast<std::size_t>(std::ranges::find(channels, channel) - channels.begin());
    };
    const std::array rgb{place_of("R"), place_of("G"), place_of("B")};
    const std::array albedo{place_of("albedo.R"), place_of("albedo.G"), place_of("albedo.B")};
    const std::size_t depth = place_of("depth.Z");
    if (std::ranges::max(rgb) == stride) {
        throw Error(ErrorKind::invalid_argument, "the exposure needs an image with channels R, G and B");
    }
    const bool knows_surfaces = depth < stride && std::ranges::max(albedo) < stride;
    ExposureMeter meter;
    for (std::size_t i = 0; i + stride <= values.size(); i += stride) {
        const std::span<const float> pixel = values.subspan(i, stride);
        const auto color_at = [&](const std::array<std::size_t, 3>& places) {
            return Vec3{pixel[places[0]], pixel[places[1]], pixel[places[2]]};
        };
        meter.add(color_at(rgb), knows_surfaces ? pixel[depth] : 0.0f,
                  knows_surfaces ? color_at(albedo) : Vec3{});
    }
    return meter.exposure();
}

}  // namespace nearlight::core
