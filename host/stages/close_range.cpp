// SPDX-License-Identifier: Apache-2.0
#include "host/stages/close_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

struct Plane {
    Vec3 normal;          // unit vector
    float offset = 0.0f;  // at the camera's origin
};

/// The plane through `origin + through` that `a` and `b` span and that faces along `inside`.
Plane make_plane(Vec3 through, Vec3 a, Vec3 b, Vec3 inside) {
    Vec3 normal = normalize(cross(normalize(a), normalize(b)));
    if (dot(normal, inside) < 0.0f) {
        normal = -normal;
    }
    return {normal, -dot(normal, through)};
}

/// The plane moved so that it encloses what is seen through any part of the lens. A point seen through the
/// lens point a, at t focus distances, lies at most |n·a|·|1 − t| outside the plane of a pinhole. The chord
/// of that bound from the camera to the range lies above it, since it is convex in t.
Plane widened(const Plane& plane, const Camera& camera, float range) {
    const float reach = std::hypot(dot(plane.normal, camera.lens_x), dot(plane.normal, camera.lens_y));
    if (reach == 0.0f) {
        return plane;
    }
    const float end = range / camera.focus_distance;
    const float slope =
        std::isfinite(end) && end > 0.0f ? reach * (std::abs(end - 1.0f) - 1.0f) / end : reach;
    const Vec3 tilted = plane.normal + camera.forward * (slope / camera.focus_distance);
    const float scale = 1.0f / length(tilted);
    return {tilted * scale, (plane.offset + reach) * scale};
}

/// The sides of the view frustum.
std::array<Plane, 4> sides(const Camera& camera, float range) {
    const Vec3 across = camera.step_x * static_cast<float>(camera.width);
    const Vec3 down = camera.step_y * static_cast<float>(camera.height);
    const std::array<Vec3, 4> corners{camera.corner, camera.corner + across, camera.corner + across + down,
                                      camera.corner + down};
    const Vec3 center = camera.corner + (across + down) * 0.5f;
    std::array<Plane, 4> planes;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 next = corners[(i + 1) % 4];
        planes[i] = camera.is_orthographic != 0
                        ? make_plane(corners[i], camera.forward, next - corners[i], center - corners[i])
                        : widened(make_plane({0, 0, 0}, corners[i], next, center), camera, range);
    }
    return planes;
}

void store(const Plane& plane, float (&to)[4]) {
    to[0] = plane.normal.x;
    to[1] = plane.normal.y;
    to[2] = plane.normal.z;
    to[3] = plane.offset;
}

}  // namespace

CloseRange make_close_range(const Camera& camera, float range) {
    CloseRange close{};
    close.origin = camera.origin;
    close.range = range;
    const std::array<Plane, 4> four = sides(camera, range);
    for (std::size_t i = 0; i < 4; ++i) {
        store(four[i], close.planes[i]);
    }
    store(make_plane(camera.forward * camera.near_clip, camera.step_x, camera.step_y, camera.forward),
          close.planes[4]);
    return close;
}

bool in_frustum(const CloseRange& close, Vec3 point, float margin) {
    const Vec3 p = point - close.origin;
    return std::all_of(std::begin(close.planes), std::end(close.planes), [&](const float(&plane)[4]) {
        return plane[0] * p.x + plane[1] * p.y + plane[2] * p.z + plane[3] >= -margin;
    });
}

}  // namespace nearlight::core
