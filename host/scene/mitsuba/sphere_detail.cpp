// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sphere_detail.h"

#include <algorithm>
#include <cmath>

#include "host/scene/mitsuba/shape_mesh.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr double kMaxTriangles = 4e6;  // of all spheres together, as long as none has fewer than kMinStacks
constexpr uint kMinStacks = 6;

// The radius of a ball of the same volume. Shapes in groups are measured where the group has them, because
// all instances share one mesh.
double mean_radius(const Object& sphere) {
    return std::cbrt(std::abs(linear_determinant(sphere.transform("to_world") * sphere_placement(sphere))));
}

// Of a shape that lies in `depth` merges. Groups hold plain shapes only.
void collect_radii(const Object& shape, uint depth, std::vector<double>& radii) {
    if (shape.type == "sphere") {
        radii.push_back(mean_radius(shape));
    } else if (shape.type == "merge" && depth < kMaxMergeDepth) {
        for (const Object* part : shape.nested("shape")) {
            collect_radii(*part, depth + 1, radii);
        }
    } else if (shape.type == "instance") {
        for (const Object* group : shape.nested("shape")) {
            for (const Object* part : group->nested("shape")) {
                if (part->type == "sphere") {
                    radii.push_back(mean_radius(*part));
                }
            }
        }
    }
}

}  // namespace

Mat4 sphere_placement(const Object& sphere) {
    const Triple center = sphere.triple("center", {0, 0, 0});
    const double radius = sphere.number("radius", 1.0);
    return translation(center[0], center[1], center[2]) * scaling(radius, radius, radius);
}

SphereDetail::SphereDetail(const std::vector<const Object*>& shapes) {
    std::vector<double> radii;
    for (const Object* shape : shapes) {
        collect_radii(*shape, 0, radii);
    }
    is_reduced_ = static_cast<double>(radii.size() * sphere_triangle_count(kFinestStacks)) > kMaxTriangles;
    for (const double radius : radii) {
        radii_ += radius;
    }
}

uint SphereDetail::stacks(const Object& sphere) const {
    const double radius = mean_radius(sphere);
    if (!is_reduced_ || !(radius > 0.0) || !std::isfinite(radius / radii_)) {
        return is_reduced_ ? kMinStacks : kFinestStacks;
    }
    const double stacks = std::sqrt(kMaxTriangles * radius / radii_ / 4.0);  // 4 n² triangles, about
    return static_cast<uint>(std::clamp(stacks, 1.0 * kMinStacks, 1.0 * kFinestStacks));
}

}  // namespace nearlight::core::mitsuba
