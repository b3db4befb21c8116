// SPDX-License-Identifier: Apache-2.0
#include "viewer/vpl_dots.h"

#include <algorithm>
#include <cmath>

#include "viewer/vectors.h"

namespace nearlight::viewer {
namespace {

/// A VPL counts as hidden where the picture is nearer by more than this part of its distance.
constexpr double kDepthMargin = 0.02;

bool is_before(const Image& image, std::size_t depth_channel, const PicturePlace& place) {
    const float depth = image.at(static_cast<int>(place.x), static_cast<int>(place.y), depth_channel);
    return depth > 0.0f && static_cast<double>(depth) < place.distance * (1.0 - kDepthMargin);
}

}  // namespace

std::vector<VplDot> vpl_dots(const Frame& frame) {
    std::vector<VplDot> dots;
    if (!frame.lights || !frame.view) {
        return dots;
    }
    float strongest = 0.0f;
    for (const VirtualPointLight& light : *frame.lights) {
        strongest = std::max(strongest, luminance(light.power));
    }
    const auto depth = std::ranges::find(frame.image.channels, "depth.Z");
    const auto depth_channel = static_cast<std::size_t>(depth - frame.image.channels.begin());
    for (std::size_t i = 0; i < frame.lights->size(); ++i) {
        const VirtualPointLight& light = (*frame.lights)[i];
        const std::optional<PicturePlace> place = frame.view->place_of(light.position);
        if (!place || !(place->x >= 0.0 && place->x < frame.image.width && place->y >= 0.0 &&
                        place->y < frame.image.height)) {
            continue;
        }
        dots.push_back(
            {.x = static_cast<float>(place->x / frame.image.width),
             .y = static_cast<float>(place->y / frame.image.height),
             .index = i,
             .is_close = light.close,
             .is_hidden =
                 depth != frame.image.channels.end() && is_before(frame.image, depth_channel, *place),
             .brightness = strongest > 0.0f ? std::cbrt(luminance(light.power) / strongest) : 0.0f});
    }
    return dots;
}

}  // namespace nearlight::viewer
