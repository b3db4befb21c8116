// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sphere_detail.h"

#include <algorithm>
#include <cmath>
#include <set>

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

/// Collects the mean radii of spheres.
struct RadiusCollector {
    std::vector<double> radii;
    std::set<const Object*> merges;  ///< each one counts once, because merges may contain themselves

    /// Of a shape that lies in `depth` merges. Groups hold plain shapes only.
    void add(const Object& shape, uint depth) {
        if (shape.type == "sphere") {
            radii.push_back(mean_radius(shape));
        } else if (shape.type == "merge" && depth < kMaxMergeDepth && merges.insert(&shape).second) {
            for (const Object* part : shape.nested("shape")) {
                add(*part, depth + 1);
            }
        } else if (shape.type == "instance") {
            for (const Object* group : shape.nested("shape")) {
                add_group(*group);
            }
        }
    }
    void add_group(const Object& group) {
        for (const Object* part : group.nested("shape")) {
            if (part->type == "sphere") {
                radii.push_back(mean_radius(*part));
            }
        }
    }
};

}  // namespace

Mat4 sphere_placement(const Object& sphere) {
    const Triple center = sphere.triple("center", {0, 0, 0});
    const double radius = sphere.number("radius", 1.0);
    return translation(center[0], center[1], center[2]) * scaling(radius, radius, radius);
}

SphereDetail::SphereDetail(const std::vector<const Object*>& shapes) {
    RadiusCollector collector;
    for (const Object* shape : shapes) {
        collector.add(*shape, 0);
    }
    const std::vector<double>& radii = collector.radii;
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
