// SPDX-License-Identifier: Apache-2.0
#include "host/reference/test_rooms.h"

#include "host/reference/synthetic_scene.h"
#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kRoomTriangles = 3000;
constexpr uint kRings = 48;
constexpr uint kSegments = 96;

Emitter delta_light(uint type, Vec3 position, Vec3 intensity) {
    Emitter light{};
    light.type = type;
    light.position = position;
    light.radiance = intensity;
    return light;
}

void add_inward_triangle(Scene& scene, uint a, uint b, uint c) {
    const Vec3 corner = scene.vertices[a].position;
    const Vec3 normal = cross(scene.vertices[b].position - corner, scene.vertices[c].position - corner);
    scene.triangles.push_back(dot(normal, corner) < 0.0f ? Triangle{a, b, c, 0} : Triangle{a, c, b, 0});
}

}  // namespace

Scene make_even_room(Vec3 albedo) {
    Scene scene = make_sphere_room(kRoomTriangles);
    for (Material& material : scene.materials) {
        material.reflectance = parameter_of(albedo);
    }
    return scene;
}

Scene make_delta_lit_room() {
    Scene scene = make_sphere_room(kRoomTriangles);
    for (Material& material : scene.materials) {
        material.emission = parameter_of(0.0f);
    }
    for (const float x : {-2.5f, -0.5f, 1.5f, 3.0f}) {
        Emitter light = delta_light(x < 0 ? NEARLIGHT_EMITTER_POINT : NEARLIGHT_EMITTER_SPOT,
                                    {x, 3.5f, 0.5f * x}, {1, 2, 3});
        light.direction = normalize(Vec3{0.2f, -1, 0.1f});
        light.beam_angle = degrees_to_radians(25);
        light.cutoff_angle = degrees_to_radians(60);
        scene.delta_emitters.push_back(light);
    }
    return scene;
}

MirrorCorner make_mirror_corner() {
    MirrorCorner corner;
    Scene& scene = corner.scene;
    scene.materials = {diffuse_material({0.5f, 0.5f, 0.5f}), conductor_material({0, 0, 0}, {1, 1, 1}),
                       diffuse_material({0, 0, 0})};
    scene.materials[2].emission = parameter_of(corner.lamp_radiance);
    const float x = corner.mirror_x;
    const float half = corner.lamp_half_side;
    add_parallelogram(scene, {x - 4, 0, -2}, {0, 0, 4}, {4, 0, 0}, 0);
    add_parallelogram(scene, {x, 0, -2}, {0, 0, 4}, {0, 2, 0}, 1);
    add_parallelogram(scene, corner.lamp - Vec3{half, 0, half}, {2 * half, 0, 0}, {0, 0, 2 * half}, 2);
    return corner;
}

Scene make_lit_sphere(float radius, float albedo) {
    Scene scene;
    scene.materials.push_back(diffuse_material({albedo, albedo, albedo}));
    for (uint ring = 0; ring <= kRings; ++ring) {
        const float theta = kPi * static_cast<float>(ring) / kRings;
        for (uint segment = 0; segment < kSegments; ++segment) {
            const float phi = 2.0f * kPi * static_cast<float>(segment) / kSegments;
            const Vec3 direction{std::sin(theta) * std::cos(phi), std::cos(theta),
                                 std::sin(theta) * std::sin(phi)};
            scene.vertices.push_back({direction * radius, 0, {0, 0, 0}, 0});
        }
    }
    for (uint ring = 0; ring < kRings; ++ring) {
        for (uint segment = 0; segment < kSegments; ++segment) {
            const uint next = (segment + 1) % kSegments;
            const uint above = ring * kSegments;
            const uint below = above + kSegments;
            if (ring > 0) {
                add_inward_triangle(scene, above + segment, above + next, below + next);
            }
            if (ring + 1 < kRings) {
                add_inward_triangle(scene, above + segment, below + next, below + segment);
            }
        }
    }
    scene.delta_emitters.push_back(delta_light(NEARLIGHT_EMITTER_POINT, {0, 0, 0}, {1, 1, 1}));
    return scene;
}

}  // namespace nearlight::core
