// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <algorithm>

#include "nearlight/error.h"

namespace nearlight::core {

std::string to_string(const Note& note) {
    std::string text = note.file.string();
    if (note.line > 0) {
        text += ':';
        text += std::to_string(note.line);
    }
    return text += ": " + note.text;
}

void check_triangle_count(std::size_t count) {
    if (count > kMaxSceneTriangles) {
        throw Error(ErrorKind::out_of_memory,
                    "scene has at least " + std::to_string(count) + " triangles, but a tree holds only " +
                        std::to_string(kMaxSceneTriangles) + "; simplify the scene");
    }
}

Aabb bounds(const Scene& scene) {
    Aabb box;
    for (const Triangle& triangle : scene.triangles) {
        box.extend(scene.vertices[triangle.v0].position);
        box.extend(scene.vertices[triangle.v1].position);
        box.extend(scene.vertices[triangle.v2].position);
    }
    return box;
}

Sphere bounding_sphere(const Scene& scene) {
    Sphere sphere{.center = bounds(scene).center()};
    for (const Triangle& triangle : scene.triangles) {
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            sphere.radius = std::max(sphere.radius, length(scene.vertices[vertex].position - sphere.center));
        }
    }
    return sphere;
}

bool has_emitting_surface(const Scene& scene) {
    return std::ranges::any_of(scene.triangles, [&](const Triangle& triangle) {
        return !is_zero(scene.materials[triangle.material].emission.value);
    });
}

bool has_light(const Scene& scene, bool surfaces_are_lamps) {
    return scene.environment.width > 0 || !scene.delta_emitters.empty() ||
           (surfaces_are_lamps && has_emitting_surface(scene));
}

float triangle_area(const Scene& scene, const Triangle& triangle) {
    const Vec3 v0 = scene.vertices[triangle.v0].position;
    const Vec3 a = scene.vertices[triangle.v1].position - v0;
    const Vec3 b = scene.vertices[triangle.v2].position - v0;
    // Double precision keeps the squares of tiny and huge edges in range.
    const auto minor = [](float p, float q, float r, float s) {
        return static_cast<double>(p) * s - static_cast<double>(q) * r;
    };
    const double x = minor(a.y, a.z, b.y, b.z);
    const double y = minor(a.z, a.x, b.z, b.x);
    const double z = minor(a.x, a.y, b.x, b.y);
    return static_cast<float>(0.5 * std::sqrt(x * x + y * y + z * z));
}

}  // namespace nearlight::core
