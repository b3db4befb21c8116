// SPDX-License-Identifier: Apache-2.0
#include "host/reference/sampling.h"

namespace nearlight::core {
Vec3 sample_cosine_hemisphere(Point2 u) {
    const float radius = std::sqrt(u.x);
    const float angle = 2.0f * kPi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1.0f - u.x))};
}

Point2 sample_triangle(Point2 u) {
    const float root = std::sqrt(1.0f - u.x);
    return {root * (1.0f - u.y), root * u.y};
}

}  // namespace nearlight::core
