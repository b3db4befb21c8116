// SPDX-License-Identifier: Apache-2.0
// Sets of triangles for which tests build trees.
#pragma once

#include <cstddef>
#include <cstring>
#include <numeric>
#include <vector>

#include "host/base/random.h"
#include "host/bvh/bvh.h"

namespace nearlight::core::test {

inline Scene scene_of_one_material() {
    Scene scene;
    scene.materials.push_back({});
    return scene;
}

inline void add_triangle(Scene& scene, Vec3 a, Vec3 b, Vec3 c) {
    const auto first = static_cast<uint>(scene.vertices.size());
    for (const Vec3 p : {a, b, c}) {
        scene.vertices.push_back({p, 0, {0, 0, 0}, 0});
    }
    scene.triangles.push_back({first, first + 1, first + 2, 0});
}

inline Vec3 random_point(Pcg32& random, float size) {
    const float x = random.uniform() - 0.5f;
    const float y = random.uniform() - 0.5f;
    const float z = random.uniform() - 0.5f;
    return Vec3{x, y, z} * size;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Triangles of about `size` anywhere in a cube of 10.
inline Scene random_soup(int count, float size, std::uint64_t seed) {
    Pcg32 random(seed);
    Scene scene = scene_of_one_material();
    for (int i = 0; i < count; ++i) {
        const Vec3 center = random_point(random, 10.0f);
        const Vec3 a = center + random_point(random, size);
        const Vec3 b = center + random_point(random, size);
        const Vec3 c = center + random_point(random, size);
        add_triangle(scene, a, b, c);
    }
    return scene;
}

/// Long thin triangles from one side of a cube to the other, whose boxes fill much of it.
inline Scene diagonals(int count, std::uint64_t seed) {
    Pcg32 random(seed);
    Scene scene = scene_of_one_material();
    for (int i = 0; i < count; ++i) {
        const Vec3 offset = random_point(random, 4.0f);
        const Vec3 end = offset + (i % 2 == 0 ? Vec3{5, 5, 5} : Vec3{5, -5, 5});
        add_triangle(scene, offset, end, end + random_point(random, 0.1f));
    }
    return scene;
}

/// A cube of n × n × n axis-aligned unit squares at integer coordinates, of two triangles each.
inline Scene aligned_squares(int n) {
    Scene scene = scene_of_one_material();
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3 p{static_cast<float>(i % n), static_cast<float>(i / n % n),
                     static_cast<float>(i / (n * n))};
        const Vec3 a = i % 3 == 0 ? Vec3{1, 0, 0} : (i % 3 == 1 ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
        const Vec3 b = i % 3 == 0 ? Vec3{0, 1, 0} : (i % 3 == 1 ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
        add_triangle(scene, p, p + a, p + a + b);
        add_triangle(scene, p, p + a + b, p + b);
    }
    return scene;
}

inline std::vector<uint> all_ids(const Scene& scene) {
    std::vector<uint> ids(scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return ids;
}

inline Bvh build_all(const Scene& scene, const BvhConfig& config = {}) {
    return build_bvh(scene, all_ids(scene), config);
}

}  // namespace nearlight::core::test
