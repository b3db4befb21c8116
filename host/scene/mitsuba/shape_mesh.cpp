// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/shape_mesh.h"

#include <numbers>

namespace nearlight::core::mitsuba {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr uint kSlices = 128;  // of disks and cylinders

// Adds a vertex, with u and v as Mitsuba gives them.
void add_vertex(Mesh& mesh, Vec3 position, Vec3 normal, double u, double v) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(1.0 - v)});
}

Vec3 to_vec3(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

double slice_angle(uint slice, uint slices = kSlices) {
    return kTwoPi * slice / slices;
}

// Adds the triangles of a grid of (rows + 1) × (slices + 1) vertices, which are already there.
void add_grid(Mesh& mesh, uint rows, uint slices) {
    for (uint row = 0; row < rows; ++row) {
        for (uint slice = 0; slice < slices; ++slice) {
            const uint a = row * (slices + 1) + slice;
            const uint b = a + slices + 1;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    }
}

// The radius of a regular polygon that has the area of the unit circle.
double disk_radius() {
    return std::sqrt(kTwoPi / (kSlices * std::sin(kTwoPi / kSlices)));
}

Vec3 sphere_point(uint stack, uint slice, uint stacks) {
    const double theta = std::numbers::pi * stack / stacks;
    const double phi = slice_angle(slice % (2 * stacks), 2 * stacks);
    // The radius of the ring is exactly zero at the poles.
    const double ring = stack == 0 || stack == stacks ? 0.0 : std::sin(theta);
    return to_vec3(ring * std::cos(phi), ring * std::sin(phi), std::cos(theta));
}

double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]];
        area += 0.5 * static_cast<double>(length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)));
    }
    return area;
}

}  // namespace

Mesh rectangle_mesh() {
    Mesh mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        add_vertex(mesh, to_vec3(x, y, 0), {0, 0, 1}, 0.5 * (x + 1), 0.5 * (y + 1));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

// A face has a normal and the axes along which u and v grow, in Mitsuba's layout.
Mesh cube_mesh() {
    struct Face {
        Vec3 normal, u, v;
    };
    constexpr Face kFaces[] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
                               {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},   {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}};
    Mesh mesh;
    for (const Face& face : kFaces) {
        const auto first = static_cast<uint>(mesh.positions.size());
        const bool right_handed = dot(cross(face.u, face.v), face.normal) > 0.0f;
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            const Vec3 position =
                face.normal + face.u * static_cast<float>(2 * u - 1) + face.v * static_cast<float>(2 * v - 1);
            add_vertex(mesh, position, face.normal, u, v);
        }
        const uint second = first + (right_handed ? 1 : 3);
        const uint last = first + (right_handed ? 3 : 1);
        mesh.triangles.push_back({first, second, first + 2});
        mesh.triangles.push_back({first, first + 2, last});
    }
    return mesh;
}

// Mitsuba's u is the distance from the middle and v the angle.
Mesh disk_mesh() {
    Mesh mesh;
    for (const double radius : {0.0, disk_radius()}) {
        for (uint slice = 0; slice <= kSlices; ++slice) {
            const double phi = slice_angle(slice);
            add_vertex(mesh, to_vec3(radius * std::cos(phi), radius * std::sin(phi), 0), {0, 0, 1},
                       std::min(radius, 1.0), phi / kTwoPi);
        }
    }
    for (uint slice = 0; slice < kSlices; ++slice) {
        const uint rim = kSlices + 1 + slice;
        mesh.triangles.push_back({slice, rim, rim + 1});
    }
    return mesh;
}

Mesh sphere_mesh(uint stacks) {
    Mesh mesh;
    const uint slices = 2 * stacks;
    for (uint stack = 0; stack <= stacks; ++stack) {
        for (uint slice = 0; slice <= slices; ++slice) {
            const Vec3 p = sphere_point(stack, slice, stacks);
            add_vertex(mesh, p, p, static_cast<double>(slice) / slices, static_cast<double>(stack) / stacks);
        }
    }
    add_grid(mesh, stacks, slices);
    // The first and last row have a triangle of no area in each cell.
    std::erase_if(mesh.triangles, [&](const auto& t) {
        const Vec3 a = mesh.positions[t[0]];
        return is_zero(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
    });
    const auto grow = static_cast<float>(std::sqrt(2.0 * kTwoPi / area_of(mesh)));
    for (Vec3& position : mesh.positions) {
        position *= grow;
    }
    return mesh;
}

Mesh cylinder_mesh() {
    Mesh mesh;
    // The sides of the polygon together are as long as the circle.
    const double radius = kTwoPi / (2.0 * kSlices * std::sin(kTwoPi / (2.0 * kSlices)));
    for (const double z : {1.0, 0.0}) {
        for (uint slice = 0; slice <= kSlices; ++slice) {
            const double phi = slice_angle(slice);
            add_vertex(mesh, to_vec3(radius * std::cos(phi), radius * std::sin(phi), z),
                       to_vec3(std::cos(phi), std::sin(phi), 0), phi / kTwoPi, z);
        }
    }
    add_grid(mesh, 1, kSlices);
    return mesh;
}

}  // namespace nearlight::core::mitsuba
