// SPDX-License-Identifier: Apache-2.0
#include "host/image/exposure_meter.h"

#include <algorithm>
#include <cmath>

#include "host/image/tone_curve.h"

namespace nearlight::core {

void ExposureMeter::add_surface(Vec3 color, Vec3 albedo) {
    constexpr float kUsualAlbedo = 0.4f;
    const float reflected = luminance(albedo);
    // Metals and dark gloss reflect more than their albedo says, so that it cannot tell the light on them.
    const float scale =
        reflected > 0.01f ? std::sqrt(kUsualAlbedo / std::clamp(reflected, 0.1f, 1.0f)) : 1.0f;
    metered_.insert(metered_.end(), {scale * color.x, scale * color.y, scale * color.z});
}

float ExposureMeter::exposure(std::span<const float> all_rgb) const {
    return automatic_exposure(metered_.empty() ? all_rgb : std::span<const float>(metered_));
}

}  // namespace nearlight::core
