// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/curves.h"

namespace nearlight::core::scenes {
namespace {

Vec3 catmull_rom(Vec3 a, Vec3 b, Vec3 c, Vec3 d, float t) {
    return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) +
                   (3.0f * b - a - 3.0f * c + d) * (t * t * t));
}

/// The outward direction. It is to the left of the direction of travel, for a profile that goes up on the
/// right of the axis.
Vec3 outward(const Curve& curve, size_t index) {
    const Vec3 ahead = curve[std::min(index + 1, curve.size() - 1)];
    const Vec3 along = normalize(ahead - curve[index > 0 ? index - 1 : 0]);
    return {along.y, -along.x, 0.0f};
}

}  // namespace

Curve spline(std::span<const Vec3> points, int steps) {
    Curve curve;
    const int last = static_cast<int>(points.size()) - 1;
    const auto point = [&](int index) { return points[static_cast<size_t>(std::clamp(index, 0, last))]; };
    for (int span = 0; span < last; ++span) {
        for (int step = 0; step < steps; ++step) {
            const float t = static_cast<float>(step) / static_cast<float>(steps);
            curve.push_back(catmull_rom(point(span - 1), point(span), point(span + 1), point(span + 2), t));
        }
    }
    curve.push_back(points.back());
    return curve;
}

Curve rounded(std::span<const Vec3> points, float radius, int steps) {
    Curve curve{points.front()};
    for (size_t index = 1; index + 1 < points.size(); ++index) {
        const Vec3 corner = points[index];
        const Vec3 before = points[index - 1] - corner, after = points[index + 1] - corner;
        const Vec3 start = corner + normalize(before) * std::min(radius, 0.5f * length(before));
        const Vec3 end = corner + normalize(after) * std::min(radius, 0.5f * length(after));
        for (int step = 0; step <= steps; ++step) {
            const float t = static_cast<float>(step) / static_cast<float>(steps);
            curve.push_back(start * ((1 - t) * (1 - t)) + corner * (2 * t * (1 - t)) + end * (t * t));
        }
    }
    curve.push_back(points.back());
    return curve;
}

Profile vessel(std::span<const Vec3> outside, float thickness, int steps) {
    const Curve outer = spline(outside, steps);
    const float foot = outer.front().y;
    Profile profile{at(0.0f, foot + 0.3f * thickness), at(outer.front().x * 0.82f, foot + 0.3f * thickness),
                    at(outer.front().x * 0.86f, foot), at(outer.front().x * 0.97f, foot)};
    profile.insert(profile.end(), outer.begin(), outer.end());
    const Vec3 lip_side = outward(outer, outer.size() - 1);
    const Vec3 lip_up{-lip_side.y, lip_side.x, 0.0f};
    const Vec3 lip_center = outer.back() - lip_side * (0.5f * thickness);
    for (int step = 1; step < 6; ++step) {
        const float angle = kPi * static_cast<float>(step) / 6.0f;
        profile.push_back(lip_center +
                          (lip_side * std::cos(angle) + lip_up * std::sin(angle)) * (0.5f * thickness));
    }
    const float floor_height = foot + 1.5f * thickness;
    for (size_t index = outer.size(); index-- > 0;) {
        const Vec3 inner = outer[index] - outward(outer, index) * thickness;
        if (inner.y <= floor_height + thickness || inner.x < 0.3f * thickness) {
            break;
        }
        profile.push_back(inner);
    }
    const float floor_radius = profile.back().x;
    profile.push_back(at(floor_radius * 0.93f, floor_height + 0.2f * thickness));
    profile.push_back(at(floor_radius * 0.8f, floor_height));
    profile.push_back(at(0.0f, floor_height));
    return profile;
}

Profile solid(std::span<const Vec3> corners, float bevel) {
    return rounded(corners, bevel, 3);
}

}  // namespace nearlight::core::scenes
