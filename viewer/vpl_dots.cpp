// SPDX-License-Identifier: Apache-2.0
#include "viewer/vpl_dots.h"

#include <algorithm>
#include <cmath>

#include "viewer/channels.h"
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
    const Channels depth = channels_of(frame.image, "depth");
    for (const VirtualPointLight& light : *frame.lights) {
        const std::optional<PicturePlace> place = frame.view->place_of(light.position);
        if (!place || !(place->x >= 0.0 && place->x < frame.image.width && place->y >= 0.0 &&
                        place->y < frame.image.height)) {
            continue;
        }
        dots.push_back(
            {.x = static_cast<float>(place->x / frame.image.width),
             .y = static_cast<float>(place->y / frame.image.height),
             .is_close = light.close,
             .is_hidden = depth.count > 0 && is_before(frame.image, depth.first, *place),
             .brightness = strongest > 0.0f ? std::cbrt(luminance(light.power) / strongest) : 0.0f});
    }
    return dots;
}

}  // namespace nearlight::viewer
