// SPDX-License-Identifier: Apache-2.0
#include "host/scene/polygon.h"

#include <algorithm>
#include <cmath>

namespace nearlight::core {
namespace {

using Triangle3 = std::array<uint, 3>;

struct PlanePoint {
    double x, y;
};

/// Twice the signed area of a triangle: above 0 if it runs counter-clockwise.
double turn(PlanePoint a, PlanePoint b, PlanePoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners in the plane in which the polygon is largest, running counter-clockwise.
std::vector<PlanePoint> flattened(std::span<const Vec3> corners) {
    std::array<double, 3> normal{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = corners[i] - corners[0];
        const Vec3 b = corners[(i + 1) % corners.size()] - corners[0];
        normal[0] += double(a.y) * b.z - double(a.z) * b.y;
        normal[1] += double(a.z) * b.x - double(a.x) * b.z;
        normal[2] += double(a.x) * b.y - double(a.y) * b.x;
    }
    const auto size = [&](int axis) { return std::abs(normal[static_cast<std::size_t>(axis)]); };
    const int axis = size(0) > size(1) && size(0) > size(2) ? 0 : size(1) > size(2) ? 1 : 2;
    const bool is_behind = normal[static_cast<std::size_t>(axis)] < 0;
    std::vector<PlanePoint> points;
    points.reserve(corners.size());
    for (const Vec3& corner : corners) {
        const Vec3 p = corner - corners[0];
        PlanePoint point = axis == 0   ? PlanePoint{p.y, p.z}
                           : axis == 1 ? PlanePoint{p.z, p.x}
                                       : PlanePoint{p.x, p.y};
        if (is_behind) {
            std::swap(point.x, point.y);
        }
        points.push_back(point);
    }
    return points;
}

bool turns_left_only(std::span<const PlanePoint> points) {
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (turn(points[i], points[(i + 1) % count], points[(i + 2) % count]) < 0) {
            return false;
        }
    }
    return true;
}

/// A polygon from which corners are cut off.
class EarCutter {
  public:
    explicit EarCutter(std::span<const PlanePoint> points) : points_(points) {
        const auto count = static_cast<uint>(points.size());
        for (uint i = 0; i < count; ++i) {
            next_.push_back(i + 1 < count ? i + 1 : 0);
            previous_.push_back(i > 0 ? i - 1 : count - 1);
        }
        for (uint i = 0; i < count; ++i) {
            if (!is_left_turn(i, previous_[i], next_[i])) {
                notches_.push_back(i);
            }
        }
    }

    std::vector<Triangle3> cut() {
        std::vector<Triangle3> triangles;
        triangles.reserve(points_.size() - 2);
        uint at = 0;
        std::size_t failures = 0;
        for (std::size_t left = points_.size(); left > 2;) {
            // Where no corner is an ear, the polygon crosses itself or has no area, and any corner will do.
            if (!is_ear(at) && failures < left) {
                ++failures;
                at = next_[at];
                continue;
            }
            triangles.push_back({previous_[at], at, next_[at]});
            next_[previous_[at]] = next_[at];
            previous_[next_[at]] = previous_[at];
            std::erase_if(notches_, [&](uint notch) {
                return notch == at || is_left_turn(notch, previous_[notch], next_[notch]);
            });
            at = next_[at];
            failures = 0;
            --left;
        }
        return triangles;
    }

  private:
    [[nodiscard]] bool is_left_turn(uint at, uint before, uint after) const {
        return turn(points_[before], points_[at], points_[after]) > 0;
    }

    /// Only a corner that is a notch can be the one that lies in an ear.
    [[nodiscard]] bool is_ear(uint at) const {
        const PlanePoint a = points_[previous_[at]];
        const PlanePoint b = points_[at];
        const PlanePoint c = points_[next_[at]];
        if (!(turn(a, b, c) > 0)) {
            return false;
        }
        return std::ranges::none_of(notches_, [&](uint notch) {
            const PlanePoint p = points_[notch];
            const bool is_corner = notch == previous_[at] || notch == at || notch == next_[at];
            return !is_corner && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 &&
                   !is_same(p, a) && !is_same(p, c);
        });
    }
    /// Polygons with holes touch themselves along a cut, where two corners are at one place.
    static bool is_same(PlanePoint p, PlanePoint q) { return p.x == q.x && p.y == q.y; }

    std::span<const PlanePoint> points_;
    std::vector<uint> next_, previous_;  // corners that are left
    std::vector<uint> notches_;          // those of them at which the polygon does not turn left
};

std::vector<Triangle3> fan(std::size_t corners) {
    std::vector<Triangle3> triangles;
    for (uint i = 2; i < corners; ++i) {
        triangles.push_back({0, i - 1, i});
    }
    return triangles;
}

}  // namespace

bool is_convex(std::span<const Vec3> corners) {
    return corners.size() < 4 || turns_left_only(flattened(corners));
}

std::vector<Triangle3> triangulate(std::span<const Vec3> corners) {
    if (corners.size() < 4 || corners.size() > kMaxEarCorners) {
        return fan(corners.size());
    }
    const std::vector<PlanePoint> points = flattened(corners);
    return turns_left_only(points) ? fan(corners.size()) : EarCutter(points).cut();
}

}  // namespace nearlight::core
