// SPDX-License-Identifier: Apache-2.0
#include "host/reference/close_range_oracle.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace nearlight::core {
namespace {

// The point of a triangle inside five half-spaces that is nearest to the camera solves a quadratic program in
// the two barycentric weights. The minimum lies inside, or on the line of a constraint.
struct Constraint {
    double a, b, c;  // a·u + b·v + c ≥ 0
};

using Double3 = std::array<double, 3>;
Double3 to_double(Vec3 v) {
    return {v.x, v.y, v.z};
}
Double3 minus(Double3 x, Double3 y) {
    return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
double dot3(Double3 x, Double3 y) {
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

bool satisfies(const std::vector<Constraint>& constraints, double u, double v, const Constraint* except) {
    return std::all_of(constraints.begin(), constraints.end(), [&](const Constraint& k) {
        return &k == except || k.a * u + k.b * v + k.c >= -1e-13;
    });
}

/// The corners' weights must not be negative, and the point must lie inside the region's planes.
std::vector<Constraint> constraints_of(const TriangleCorners& t, const CloseRange& region, double slack) {
    const Double3 a = minus(to_double(t.a), to_double(region.origin));
    const Double3 e = minus(to_double(t.b), to_double(t.a));
    const Double3 f = minus(to_double(t.c), to_double(t.a));
    std::vector<Constraint> constraints{{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};
    for (const auto& plane : region.planes) {
        const Double3 n{plane[0], plane[1], plane[2]};
        constraints.push_back({dot3(n, e), dot3(n, f), dot3(n, a) + double{plane[3]} + slack});
    }
    return constraints;
}

/// The part of a constraint's border on which the others hold: the points (u0 + s · du, v0 + s · dv) for s
/// from `low` to `high`. There is none if low > high.
struct Border {
    double u0 = 0, v0 = 0, du = 0, dv = 0;
    double low = 1, high = 0;
};
Border border_of(const std::vector<Constraint>& constraints, const Constraint& line) {
    const double norm = line.a * line.a + line.b * line.b;
    if (!(norm > 0)) {
        return {};
    }
    Border border{-line.a * line.c / norm, -line.b * line.c / norm, -line.b, line.a, -1e300, 1e300};
    for (const Constraint& k : constraints) {
        const double slope = k.a * border.du + k.b * border.dv;
        const double height = k.a * border.u0 + k.b * border.v0 + k.c;
        if (&k == &line) {
            continue;
        }
        if (std::abs(slope) < 1e-300) {
            border.high = height < 0 ? -2e300 : border.high;
        } else if (slope > 0) {
            border.low = std::max(border.low, -height / slope);
        } else {
            border.high = std::min(border.high, -height / slope);
        }
    }
    return border;
}

}  // namespace

double nearest_squared_distance(const TriangleCorners& t, const CloseRange& region, double slack) {
    const Double3 a = minus(to_double(t.a), to_double(region.origin));
    const Double3 e = minus(to_double(t.b), to_double(t.a));
    const Double3 f = minus(to_double(t.c), to_double(t.a));
    const std::vector<Constraint> constraints = constraints_of(t, region, slack);
    const double ee = dot3(e, e), ef = dot3(e, f), ff = dot3(f, f), ae = dot3(a, e), af = dot3(a, f);
    const auto squared = [&](double u, double v) {
        return dot3(a, a) + u * u * ee + v * v * ff + 2 * (u * v * ef + u * ae + v * af);
    };
    double best = std::numeric_limits<double>::infinity();
    const double determinant = ee * ff - ef * ef;
    if (const double u = (ef * af - ff * ae) / determinant, v = (ef * ae - ee * af) / determinant;
        satisfies(constraints, u, v, nullptr)) {
        best = squared(u, v);
    }
    for (const Constraint& line : constraints) {
        const auto [u0, v0, du, dv, low, high] = border_of(constraints, line);
        if (low <= high) {
            const double curvature = du * du * ee + dv * dv * ff + 2 * du * dv * ef;
            const double gradient =
                u0 * du * ee + v0 * dv * ff + (u0 * dv + v0 * du) * ef + du * ae + dv * af;
            const double s = std::clamp(curvature > 0 ? -gradient / curvature : low, low, high);
            best = std::min(best, squared(u0 + s * du, v0 + s * dv));
        }
    }
    return best;
}

double part_between_planes(const TriangleCorners& t, const CloseRange& region, double slack) {
    std::vector<Constraint> constraints = constraints_of(t, region, slack);
    const Double3 n{-region.planes[4][0], -region.planes[4][1], -region.planes[4][2]};
    constraints.push_back({dot3(n, minus(to_double(t.b), to_double(t.a))),
                           dot3(n, minus(to_double(t.c), to_double(t.a))),
                           dot3(n, minus(to_double(t.a), to_double(region.origin))) + region.range + slack});
    // By Green's theorem; the borders run clockwise around the part.
    double twice_area = 0;
    for (const Constraint& line : constraints) {
        const auto [u0, v0, du, dv, low, high] = border_of(constraints, line);
        if (low < high) {
            twice_area -= (u0 * dv - v0 * du) * (high - low);
        }
    }
    return twice_area;
}

bool close_flag_fits(const CloseRange& region, Vec3 p, bool flag, float slack) {
    const Vec3 q = p - region.origin;
    bool surely_inside = true;
    bool surely_outside = false;
    for (const auto& plane : region.planes) {
        const float height = plane[0] * q.x + plane[1] * q.y + plane[2] * q.z + plane[3];
        surely_inside = surely_inside && height > slack;
        surely_outside = surely_outside || height < -slack;
    }
    const float distance = length(q);
    surely_inside = surely_inside && distance < region.range - slack;
    surely_outside = surely_outside || distance > region.range + slack;
    return flag ? !surely_outside : !surely_inside;
}

}  // namespace nearlight::core
