// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

float component(Vec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Grid lines of a rounded box along one axis: 2·segments + 2 of them, half on each rounded edge.
struct BoxLattice {
    Vec3 half;
    float bevel;
    int segments;

    [[nodiscard]] int lines() const { return 2 * segments + 2; }
    [[nodiscard]] float slope(int line) const {
        const int from_middle = line <= segments ? line - segments : line - segments - 1;
        return std::tan(0.25f * kPi * static_cast<float>(from_middle) / static_cast<float>(segments));
    }
    [[nodiscard]] Vec3 normal(const std::array<int, 3>& line) const {
        return normalize({slope(line[0]), slope(line[1]), slope(line[2])});
    }
    [[nodiscard]] Vec3 position(const std::array<int, 3>& line) const {
        const auto side = [&](int axis) {
            return line[static_cast<size_t>(axis)] <= segments ? -1.0f : 1.0f;
        };
        const Vec3 core{side(0) * (half.x - bevel), side(1) * (half.y - bevel) + half.y,
                        side(2) * (half.z - bevel)};
        return core + normal(line) * bevel;
    }
};

void add_box_face(Mesh& mesh, const BoxLattice& lattice, int axis, bool far_side) {
    const int lines = lattice.lines();
    int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    const bool u_is_longer = component(lattice.half, u_axis) >= component(lattice.half, v_axis);
    const auto first = static_cast<uint>(mesh.vertices.size());
    for (int j = 0; j < lines; ++j) {
        for (int i = 0; i < lines; ++i) {
            std::array<int, 3> line{};
            line[static_cast<size_t>(axis)] = far_side ? lines - 1 : 0;
            line[static_cast<size_t>(u_axis)] = i;
            line[static_cast<size_t>(v_axis)] = j;
            const Vec3 p = lattice.position(line);
            const float u = component(p, u_axis), v = component(p, v_axis);
            mesh.add_vertex(p, lattice.normal(line), u_is_longer ? u : v, u_is_longer ? v : u);
        }
    }
    for (int j = 0; j + 1 < lines; ++j) {
        for (int i = 0; i + 1 < lines; ++i) {
            const uint a = first + static_cast<uint>(j * lines + i);
            const uint b = a + 1, d = a + static_cast<uint>(lines), c = d + 1;
            far_side ? mesh.add_quad(a, b, c, d) : mesh.add_quad(a, d, c, b);
        }
    }
}

/// Adds quads between rings of `segments` + 1 vertices each. The last vertex of a ring is at the place of the
/// first.
void connect_rings(Mesh& mesh, size_t rings, int segments) {
    const auto stride = static_cast<uint>(segments + 1);
    for (uint ring = 0; ring + 1 < rings; ++ring) {
        for (uint segment = 0; segment + 1 < stride; ++segment) {
            const uint a = ring * stride + segment;
            mesh.add_quad(a, a + 1, a + stride + 1, a + stride);
        }
    }
}

Vec3 profile_normal(const Profile& profile, size_t index) {
    Vec3 sum{0, 0, 0};
    const auto add = [&](Vec3 from, Vec3 to) { sum += Vec3{to.y - from.y, from.x - to.x, 0.0f}; };
    if (index > 0) {
        add(profile[index - 1], profile[index]);
    }
    if (index + 1 < profile.size()) {
        add(profile[index], profile[index + 1]);
    }
    const bool on_axis = profile[index].x == 0.0f;
    return on_axis ? normalize({0.0f, sum.y, 0.0f}) : normalize(sum);
}

float interpolate(const std::vector<float>& values, float t) {
    const float place = t * static_cast<float>(values.size() - 1);
    const auto index = std::min(static_cast<size_t>(place), values.size() - 1);
    const size_t next = std::min(index + 1, values.size() - 1);
    const float rest = place - static_cast<float>(index);
    return values[index] * (1.0f - rest) + values[next] * rest;
}

/// One ring of a tube: its centre, its radius and the lean of its normals.
struct TubeRing {
    Vec3 center, forward;
    float radius;
    float lean;  // sine of the angle between normal and cross section, positive towards `forward`
};

std::vector<TubeRing> tube_rings(const Curve& curve, const TubeShape& shape) {
    constexpr int kCapRings = 5;
    std::vector<TubeRing> rings;
    const size_t count = curve.size();
    const auto forward = [&](size_t i) {
        return normalize(curve[std::min(i + 1, count - 1)] - curve[i > 0 ? i - 1 : 0]);
    };
    const auto cap = [&](size_t i, float radius, float sign, int step) {
        const float angle = 0.5f * kPi * static_cast<float>(step) / kCapRings;
        const float around = step == kCapRings ? 0.0f : std::cos(angle);
        const float reach = sign * std::sin(angle) * std::min(1.0f, shape.flatness);
        rings.push_back(
            {curve[i] + forward(i) * (reach * radius), forward(i), radius * around, sign * std::sin(angle)});
    };
    for (int step = kCapRings; step > 0; --step) {
        cap(0, shape.radii.front(), -1.0f, step);
    }
    for (size_t i = 0; i < count; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(count - 1);
        rings.push_back({curve[i], forward(i), interpolate(shape.radii, t), 0.0f});
    }
    for (int step = 1; step <= kCapRings; ++step) {
        cap(count - 1, shape.radii.back(), 1.0f, step);
    }
    return rings;
}

/// Adds one side of a sheet: the surface moved along its normals, which point away from the middle of the
/// sheet.
void add_sheet_side(Mesh& mesh, const std::function<Vec3(float, float)>& surface, int u_steps, int v_steps,
                    float offset) {
    constexpr float h = 1e-3f;
    for (int j = 0; j <= v_steps; ++j) {
        for (int i = 0; i <= u_steps; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(u_steps);
            const float v = static_cast<float>(j) / static_cast<float>(v_steps);
            const Vec3 du = surface(u + h, v) - surface(u - h, v);
            const Vec3 dv = surface(u, v + h) - surface(u, v - h);
            const Vec3 up = normalize(cross(dv, du));
            mesh.add_vertex(surface(u, v) + up * offset, offset > 0 ? up : -up, u, v);
        }
    }
}

/// Adds a strip, with its own normal, between the upper edge from a to b and the lower edge.
void add_sheet_rim(Mesh& mesh, uint a, uint b, uint below) {
    const std::array<Vertex, 4> corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[below + b],
                                        mesh.vertices[below + a]};
    const Vec3 origin = corners[0].position;
    const Vec3 normal = normalize(cross(corners[1].position - origin, corners[3].position - origin));
    const auto first = static_cast<uint>(mesh.vertices.size());
    for (const Vertex& corner : corners) {
        mesh.add_vertex(corner.position, normal, corner.u, corner.v);
    }
    mesh.add_quad(first, first + 1, first + 2, first + 3);
}

/// A mesh of the triangles with only the vertices that they use.
Mesh compacted(const std::vector<Vertex>& vertices, const std::vector<std::array<uint, 3>>& triangles) {
    constexpr uint kUnused = ~0u;
    std::vector<uint> renumbered(vertices.size(), kUnused);
    Mesh mesh;
    for (std::array<uint, 3> triangle : triangles) {
        for (uint& index : triangle) {
            if (renumbered[index] == kUnused) {
                renumbered[index] = static_cast<uint>(mesh.vertices.size());
                mesh.vertices.push_back(vertices[index]);
            }
            index = renumbered[index];
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace

Mesh box(Vec3 size, float bevel, int segments) {
    const Vec3 half = size * 0.5f;
    const float smallest = std::min(half.x, std::min(half.y, half.z));
    const BoxLattice lattice{half, std::min(bevel, 0.98f * smallest), segments};
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        add_box_face(mesh, lattice, axis, false);
        add_box_face(mesh, lattice, axis, true);
    }
    return mesh;
}

Mesh lathe(const Profile& profile, int segments) {
    Mesh mesh;
    for (int i = 0; i < static_cast<int>(profile.size()); ++i) {
        const Vec3 point = profile[static_cast<size_t>(i)];
        const Vec3 normal = profile_normal(profile, static_cast<size_t>(i));
        for (int segment = 0; segment <= segments; ++segment) {
            const float angle =
                2.0f * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
            const float c = std::cos(angle), s = std::sin(angle);
            mesh.add_vertex({point.x * s, point.y, point.x * c}, {normal.x * s, normal.y, normal.x * c},
                            static_cast<float>(segment) / static_cast<float>(segments),
                            static_cast<float>(i) / static_cast<float>(profile.size() - 1));
        }
    }
    connect_rings(mesh, profile.size(), segments);
    return mesh;
}

Mesh cylinder(float radius, float height, float bevel, int segments) {
    const Profile corners{at(0, 0), at(radius, 0), at(radius, height), at(0, height)};
    return lathe(solid(corners, bevel), segments);
}

Mesh ellipsoid(Vec3 radii, int segments) {
    Profile profile;
    const int rings = segments / 2;
    for (int ring = 0; ring <= rings; ++ring) {
        const float angle = kPi * static_cast<float>(ring) / static_cast<float>(rings);
        const bool pole = ring == 0 || ring == rings;
        profile.push_back(at(pole ? 0.0f : std::sin(angle), -std::cos(angle)));
    }
    return scaled(lathe(profile, segments), radii);
}

Mesh torus(float radius, float tube_radius, int segments, int tube_segments) {
    Profile profile;
    for (int step = 0; step <= tube_segments; ++step) {
        const float angle =
            2.0f * kPi * static_cast<float>(step % tube_segments) / static_cast<float>(tube_segments);
        profile.push_back(at(radius + tube_radius * std::cos(angle), tube_radius * std::sin(angle)));
    }
    return smoothed(lathe(profile, segments));
}

Mesh tube(const Curve& curve, const TubeShape& shape) {
    const std::vector<TubeRing> rings = tube_rings(curve, shape);
    Mesh mesh;
    Vec3 side = orthonormal_basis(rings.front().forward)[0];
    for (const TubeRing& ring : rings) {
        side = normalize(side - ring.forward * dot(side, ring.forward));
        const Vec3 up = cross(ring.forward, side);
        for (int i = 0; i <= shape.sides; ++i) {
            const float angle =
                2.0f * kPi * static_cast<float>(i % shape.sides) / static_cast<float>(shape.sides);
            const float c = std::cos(angle), s = std::sin(angle);
            const Vec3 offset = (side * c + up * (s * shape.flatness)) * ring.radius;
            const Vec3 around = normalize(side * (c * shape.flatness) + up * s);
            const Vec3 normal =
                around * std::sqrt(std::max(0.0f, 1.0f - ring.lean * ring.lean)) + ring.forward * ring.lean;
            mesh.add_vertex(ring.center + offset, normalize(normal),
                            static_cast<float>(i) / static_cast<float>(shape.sides));
        }
    }
    connect_rings(mesh, rings.size(), shape.sides);
    return shape.facets ? faceted(mesh) : mesh;
}

Mesh sheet(const std::function<Vec3(float, float)>& surface, int u_steps, int v_steps, float thickness) {
    Mesh mesh;
    add_sheet_side(mesh, surface, u_steps, v_steps, 0.5f * thickness);
    add_sheet_side(mesh, surface, u_steps, v_steps, -0.5f * thickness);
    const auto below = static_cast<uint>(mesh.vertices.size() / 2);
    const auto index = [&](int i, int j) { return static_cast<uint>(j * (u_steps + 1) + i); };
    for (int j = 0; j < v_steps; ++j) {
        for (int i = 0; i < u_steps; ++i) {
            const uint a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
            mesh.add_quad(a, d, c, b);
            mesh.add_quad(below + a, below + b, below + c, below + d);
        }
    }
    for (int i = 0; i < u_steps; ++i) {
        add_sheet_rim(mesh, index(i, 0), index(i + 1, 0), below);
        add_sheet_rim(mesh, index(i + 1, v_steps), index(i, v_steps), below);
    }
    for (int j = 0; j < v_steps; ++j) {
        add_sheet_rim(mesh, index(0, j + 1), index(0, j), below);
        add_sheet_rim(mesh, index(u_steps, j), index(u_steps, j + 1), below);
    }
    return mesh;
}

std::pair<Mesh, Mesh> split(const Mesh& mesh, const std::function<bool(Vec3)>& inside) {
    std::pair<Mesh, Mesh> result;
    for (const auto& triangle : mesh.triangles) {
        const Vec3 center = (mesh.vertices[triangle[0]].position + mesh.vertices[triangle[1]].position +
                             mesh.vertices[triangle[2]].position) /
                            3.0f;
        (inside(center) ? result.first : result.second).triangles.push_back(triangle);
    }
    result.first = compacted(mesh.vertices, result.first.triangles);
    result.second = compacted(mesh.vertices, result.second.triangles);
    return result;
}

}  // namespace nearlight::core::scenes
