// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/mesh.h"

#include <tuple>

#include "scenes/generator/noise.h"

namespace nearlight::core::scenes {

uint Mesh::add_vertex(Vec3 position, Vec3 normal, float u, float v) {
    vertices.push_back({position, u, normal, v});
    return static_cast<uint>(vertices.size() - 1);
}

void Mesh::add_triangle(uint a, uint b, uint c) {
    const Vec3 p = vertices[a].position, q = vertices[b].position, r = vertices[c].position;
    if (!(p == q) && !(q == r) && !(r == p)) {
        triangles.push_back({a, b, c});
    }
}

void Mesh::add_quad(uint a, uint b, uint c, uint d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
}

Mesh& Mesh::append(const Mesh& other) {
    const auto first = static_cast<uint>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    triangles.reserve(triangles.size() + other.triangles.size());
    for (const auto& [a, b, c] : other.triangles) {
        triangles.push_back({first + a, first + b, first + c});
    }
    return *this;
}

Mesh operator+(Mesh a, const Mesh& b) {
    a.append(b);
    return a;
}

Mesh transformed(Mesh mesh, const Mat4& matrix) {
    const Mat4 inverse_matrix = inverse(matrix);
    for (Vertex& vertex : mesh.vertices) {
        vertex.position = transform_point(matrix, vertex.position);
        vertex.normal = normalize(transform_normal_by_inverse(inverse_matrix, vertex.normal));
    }
    if (linear_determinant(matrix) < 0.0) {
        for (auto& triangle : mesh.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    return mesh;
}

Mesh moved(Mesh mesh, Vec3 offset) {
    for (Vertex& vertex : mesh.vertices) {
        vertex.position += offset;
    }
    return mesh;
}

Mesh turned(Mesh mesh, Vec3 axis, float degrees) {
    return transformed(std::move(mesh), rotation(axis.x, axis.y, axis.z, degrees));
}

Mesh scaled(Mesh mesh, Vec3 factors) {
    return transformed(std::move(mesh), scaling(factors.x, factors.y, factors.z));
}

Mesh faceted(const Mesh& mesh) {
    Mesh result;
    for (const auto& triangle : mesh.triangles) {
        const Vertex corners[3] = {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                                   mesh.vertices[triangle[2]]};
        const Vec3 normal = normalize(
            cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position));
        for (const Vertex& corner : corners) {
            result.add_vertex(corner.position, normal, corner.u, corner.v);
        }
        const auto last = static_cast<uint>(result.vertices.size());
        result.triangles.push_back({last - 3, last - 2, last - 1});
    }
    return result;
}

Mesh smoothed(Mesh mesh) {
    const auto key = [&](uint index) {
        const Vec3 p = mesh.vertices[index].position;
        return std::tuple(p.x, p.y, p.z);
    };
    std::map<std::tuple<float, float, float>, Vec3> sums;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 origin = mesh.vertices[a].position;
        const Vec3 area = cross(mesh.vertices[b].position - origin, mesh.vertices[c].position - origin);
        for (const uint index : {a, b, c}) {
            sums.try_emplace(key(index), Vec3{0, 0, 0}).first->second += area;
        }
    }
    for (uint index = 0; index < mesh.vertices.size(); ++index) {
        const auto sum = sums.find(key(index));
        if (sum != sums.end() && length(sum->second) > 0.0f) {
            mesh.vertices[index].normal = normalize(sum->second);
        }
    }
    return mesh;
}

Mesh roughened(Mesh mesh, float amplitude, float frequency) {
    for (Vertex& vertex : mesh.vertices) {
        vertex.position += vertex.normal * (amplitude * fractal_noise(vertex.position * frequency, 3));
    }
    return smoothed(std::move(mesh));
}

Aabb bounds(const Mesh& mesh) {
    Aabb box;
    for (const Vertex& vertex : mesh.vertices) {
        box.extend(vertex.position);
    }
    return box;
}

void Model::add(const Model& other, const Mat4& placement) {
    for (const auto& [part, mesh] : other.parts_) {
        add(part, transformed(mesh, placement));
    }
}

void Model::place(const Model& other, Vec3 position, float degrees) {
    add(other, translation(position.x, position.y, position.z) * rotation(0, 1, 0, degrees));
}

}  // namespace nearlight::core::scenes
