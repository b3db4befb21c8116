// SPDX-License-Identifier: Apache-2.0
#include "host/reference/synthetic_scene.h"

#include <algorithm>
#include <cmath>

#include "host/base/random.h"
#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

constexpr Vec3 kRoomMin{-4.0f, 0.0f, -4.0f};
constexpr Vec3 kRoomMax{4.0f, 4.0f, 4.0f};
// Each two-sided material stands after the one that it shows on both sides.
constexpr uint kWallMaterial = 1;
constexpr uint kSphereMaterial = 3;
constexpr uint kLampMaterial = 5;
constexpr int kSphereRings = 16;  // 2·(16 − 1)·32 triangles per sphere
constexpr int kSphereSegments = 32;
constexpr std::size_t kSphereTriangles = 2 * (kSphereRings - 1) * kSphereSegments;

uint add_vertex(Scene& scene, Vec3 position) {
    Vertex vertex{};
    vertex.position = position;
    scene.vertices.push_back(vertex);
    return static_cast<uint>(scene.vertices.size() - 1);
}

void add_room(Scene& scene) {
    const Vec3 size = kRoomMax - kRoomMin;
    const Vec3 x{size.x, 0, 0};
    const Vec3 y{0, size.y, 0};
    const Vec3 z{0, 0, size.z};
    add_parallelogram(scene, kRoomMin, z, x, kWallMaterial);      // floor
    add_parallelogram(scene, kRoomMin + y, x, z, kWallMaterial);  // ceiling
    add_parallelogram(scene, kRoomMin, x, y, kWallMaterial);      // back
    add_parallelogram(scene, kRoomMin + z, y, x, kWallMaterial);  // front
    add_parallelogram(scene, kRoomMin, y, z, kWallMaterial);      // left
    add_parallelogram(scene, kRoomMin + x, z, y, kWallMaterial);  // right
    add_parallelogram(scene, {-0.5f, 3.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, kLampMaterial);
}

void add_noisy_sphere(Scene& scene, Vec3 center, float radius, Pcg32& random) {
    const auto first = static_cast<uint>(scene.vertices.size());
    for (int ring = 0; ring <= kSphereRings; ++ring) {
        const float theta = kPi * static_cast<float>(ring) / kSphereRings;
        for (int segment = 0; segment < kSphereSegments; ++segment) {
            const float phi = 2.0f * kPi * static_cast<float>(segment) / kSphereSegments;
            const float r = radius * (0.85f + 0.15f * random.uniform());
            add_vertex(scene, center + r * Vec3{std::sin(theta) * std::cos(phi), std::cos(theta),
                                                std::sin(theta) * std::sin(phi)});
        }
    }
    for (uint ring = 0; ring < kSphereRings; ++ring) {
        for (uint segment = 0; segment < kSphereSegments; ++segment) {
            const uint next = (segment + 1) % kSphereSegments;
            const uint a = first + ring * kSphereSegments;
            const uint b = a + kSphereSegments;
            if (ring > 0) {
                scene.triangles.push_back({a + segment, a + next, b + next, kSphereMaterial});
            }
            if (ring + 1 < kSphereRings) {
                scene.triangles.push_back({a + segment, b + next, b + segment, kSphereMaterial});
            }
        }
    }
}

void set_camera(Scene& scene) {
    scene.camera.to_world = look_at({0.0, 2.2, -3.8}, {0.0, 0.9, 0.0}, {0.0, 1.0, 0.0});
    scene.camera.fov_x_degrees = 70.0;
    scene.camera.width = 512;
    scene.camera.height = 512;
}

}  // namespace

Scene make_sphere_room(std::size_t triangle_count, std::uint64_t seed) {
    Scene scene;
    scene.name = "sphere-room-" + std::to_string(triangle_count);
    for (const Vec3 color : {Vec3{0.7f, 0.7f, 0.7f}, Vec3{0.6f, 0.45f, 0.3f}, Vec3{0, 0, 0}}) {
        add_two_sided(scene, diffuse_material(color));
    }
    scene.materials[kLampMaterial].emission = parameter_of(Vec3{20, 20, 20});
    add_room(scene);
    Pcg32 random(seed);
    const std::size_t spheres = std::max<std::size_t>(1, triangle_count / kSphereTriangles);
    const float radius = 1.6f / std::cbrt(static_cast<float>(spheres));
    const Vec3 size = kRoomMax - kRoomMin;
    for (std::size_t i = 0; i < spheres; ++i) {
        // Spheres are denser towards the floor, as things in rooms are.
        const Vec3 place{random.uniform(), random.uniform(), random.uniform()};
        const Vec3 center = kRoomMin + Vec3{place.x, 0.6f * place.y * place.y, place.z} * size;
        add_noisy_sphere(scene, center, radius * (0.4f + 0.6f * random.uniform()), random);
    }
    set_camera(scene);
    return scene;
}

}  // namespace nearlight::core
