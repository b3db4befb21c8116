// SPDX-License-Identifier: Apache-2.0
#include "host/stages/close_range.h"

#include <array>

#include "host/base/math.h"

namespace nearlight {
namespace {

/// Through the camera, its normal on the side that `inside` points to.
void set_plane(float (&plane)[4], Vec3 normal, Vec3 inside, Vec3 origin) {
    Vec3 n = normalize(normal);
    n = dot(n, inside) < 0.0f ? -n : n;
    plane[0] = n.x;
    plane[1] = n.y;
    plane[2] = n.z;
    plane[3] = -dot(n, origin);
}

}  // namespace

CloseRange make_close_range(const PinholeCamera& camera, float range) {
    const Vec3 across = camera.step_x * static_cast<float>(camera.width);
    const Vec3 down = camera.step_y * static_cast<float>(camera.height);
    const std::array<Vec3, 4> corners{camera.corner, camera.corner + across, camera.corner + across + down,
                                      camera.corner + down};
    const Vec3 center = camera.corner + across * 0.5f + down * 0.5f;
    CloseRange region{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        set_plane(region.planes[i], cross(corners[i], corners[(i + 1) % 4]), center, camera.origin);
    }
    set_plane(region.planes[4], cross(across, down), center, camera.origin);
    region.origin = camera.origin;
    region.range = range;
    return region;
}

}  // namespace nearlight
