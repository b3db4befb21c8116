// SPDX-License-Identifier: Apache-2.0
#include "host/stages/close_range.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

/// Sets a plane through `origin` that `a` and `b` span and that faces the point `inside`.
void set_plane(float (&plane)[4], Vec3 origin, Vec3 a, Vec3 b, Vec3 inside) {
    Vec3 normal = normalize(cross(normalize(a), normalize(b)));
    if (dot(normal, inside) < 0.0f) {
        normal = -normal;
    }
    plane[0] = normal.x;
    plane[1] = normal.y;
    plane[2] = normal.z;
    plane[3] = static_cast<float>(
        -(double{normal.x} * origin.x + double{normal.y} * origin.y + double{normal.z} * origin.z));
}

}  // namespace

CloseRange make_close_range(const PinholeCamera& camera, float range) {
    const Vec3 across = camera.step_x * static_cast<float>(camera.width);
    const Vec3 down = camera.step_y * static_cast<float>(camera.height);
    const std::array<Vec3, 4> corners{camera.corner, camera.corner + across, camera.corner + across + down,
                                      camera.corner + down};
    const Vec3 center = camera.corner + (across + down) * 0.5f;
    CloseRange close{};
    close.origin = camera.origin;
    close.range = range;
    for (std::size_t i = 0; i < 4; ++i) {
        set_plane(close.planes[i], camera.origin, corners[i], corners[(i + 1) % 4], center);
    }
    set_plane(close.planes[4], camera.origin, across, down, center);
    return close;
}

bool in_frustum(const CloseRange& close, Vec3 point, float margin) {
    return std::all_of(std::begin(close.planes), std::end(close.planes), [&](const float(&plane)[4]) {
        return plane[0] * point.x + plane[1] * point.y + plane[2] * point.z + plane[3] >= -margin;
    });
}

}  // namespace nearlight::core
