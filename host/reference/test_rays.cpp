// SPDX-License-Identifier: Apache-2.0
#include "host/reference/test_rays.h"

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

constexpr float kFar = 1e10f;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Vec3 point_in_cube(Pcg32& random) {
    const float x = 2.0f * random.uniform() - 1.0f;
    const float y = 2.0f * random.uniform() - 1.0f;
    return {x, y, 2.0f * random.uniform() - 1.0f};
}

RayFamily random_rays(std::size_t count, Pcg32& random) {
    RayFamily family{.name = "random", .rays = {}};
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 origin = point_in_cube(random) * 1.5f;
        const float t_max = i % 3 == 0 ? random.uniform() : kFar;
        family.rays.push_back({origin, 0.0f, point_in_cube(random) - origin, t_max});
    }
    return family;
}

RayFamily axis_aligned_rays(std::size_t count, Pcg32& random) {
    RayFamily family{.name = "axis-aligned", .rays = {}};
    for (std::size_t i = 0; i < count; ++i) {
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        const float zero = i % 4 < 2 ? 0.0f : -0.0f;
        const Vec3 direction{i % 3 == 0 ? sign : zero, i % 3 == 1 ? sign : zero, i % 3 == 2 ? sign : zero};
        family.rays.push_back({point_in_cube(random) * 1.5f, 0.0f, direction, kFar});
    }
    return family;
}

RayFamily grazing_rays(const Scene& scene, std::size_t count, Pcg32& random) {
    RayFamily family{.name = "grazing", .rays = {}, .meets_edges = true};
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& triangle = scene.triangles[random.next() % scene.triangles.size()];
        const Vec3 a = scene.vertices[triangle.v0].position;
        const Vec3 b = scene.vertices[triangle.v1].position;
        const Vec3 c = scene.vertices[triangle.v2].position;
        const Vec3 origin = point_in_cube(random) * 1.5f;
        const std::array<RayQuery, 4> rays{{{origin, 0.0f, a - origin, kFar},
                                            {origin, 0.0f, (b + c) * 0.5f - origin, kFar},
                                            {a - (b - a), 0.0f, b - a, kFar},
                                            {a + (b - a) * 2.0f, 0.0f, (a - b) + (c - a) * 0.05f, kFar}}};
        family.rays.push_back(rays[i % rays.size()]);
    }
    return family;
}

}  // namespace

Scene make_triangle_soup(std::size_t triangle_count, std::uint64_t seed) {
    Scene scene;
    scene.materials.push_back(diffuse_material({0, 0, 0}));
    Pcg32 random(seed);
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const Vec3 a = point_in_cube(random);
        Vec3 b = a + point_in_cube(random) * 0.3f;
        Vec3 c = a + point_in_cube(random) * 0.3f;
        if (i % 5 == 0) {
            b.y = c.y = a.y;
        }
        if (i % 17 == 0) {
            c = b;
        }
        if (i % 19 == 0) {
            c = a + (b - a) * 0.5f;
        }
        const uint first = static_cast<uint>(scene.vertices.size());
        for (const Vec3 p : {a, b, c}) {
            scene.vertices.push_back({.position = p, .u = 0, .normal = {0, 0, 0}, .v = 0});
        }
        scene.triangles.push_back({first, first + 1, first + 2, 0});
    }
    return scene;
}

std::vector<RayFamily> make_ray_families(const Scene& scene, std::size_t count, std::uint64_t seed) {
    Pcg32 random(seed);
    return {random_rays(count, random), axis_aligned_rays(count, random), grazing_rays(scene, count, random)};
}

std::vector<RayQuery> make_broken_rays() {
    std::vector<RayQuery> rays{{{0, 0, 0}, 0.0f, {0, 0, 0}, kInfinity},
                               {{0, 0, 0}, kNaN, {0, 0.1f, 1}, kInfinity},
                               {{0, 0, 0}, 0.0f, {0, 0.1f, 1}, kNaN},
                               {{-3, 0, 0}, 5.0f, {1, 0.01f, 0.02f}, 1.0f}};
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 broken{axis == 0 ? bad : 0.1f, axis == 1 ? bad : 0.2f, axis == 2 ? bad : 0.3f};
            rays.push_back({broken, 0.0f, {0.1f, 0.2f, 1}, kInfinity});
            rays.push_back({{0, 0, 0}, 0.0f, broken, kInfinity});
        }
    }
    return rays;
}

}  // namespace nearlight::core
