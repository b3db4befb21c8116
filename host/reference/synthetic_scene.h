// SPDX-License-Identifier: Apache-2.0
// Scenes that are built in code: one of any size for benchmarks that have no file.
#pragma once

#include "host/scene/scene.h"

namespace nearlight::core {

/// Adds the parallelogram corner, corner + a, corner + a + b, corner + b, whose front is on the side of a ×
/// b.
inline void add_parallelogram(Scene& scene, Vec3 corner, Vec3 a, Vec3 b, uint material) {
    const auto first = static_cast<uint>(scene.vertices.size());
    for (const Vec3 position : {corner, corner + a, corner + a + b, corner + b}) {
        scene.vertices.push_back({position, 0, {0, 0, 0}, 0});
    }
    scene.triangles.push_back({first, first + 1, first + 2, material});
    scene.triangles.push_back({first, first + 2, first + 3, material});
}

/// A room of 8 × 4 × 8 m with a lamp under its ceiling and a floor full of spheres whose surface is rough
/// noise, about `triangle_count` triangles in all. The same arguments give the same scene on every machine.
Scene make_sphere_room(std::size_t triangle_count, std::uint64_t seed = 1);

}  // namespace nearlight::core
