// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/front_normals.h"

#include <algorithm>
#include <array>

namespace nearlight::core::gltf {
namespace {

using Corners = std::array<uint, 3>;

/// The rule by which append_mesh() finds the front, whose normals are of length 1.
bool is_against_normals(const Mesh& mesh, const Corners& t) {
    const Vec3 geometric =
        cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    const Vec3 sum =
        normalize(mesh.normals[t[0]]) + normalize(mesh.normals[t[1]]) + normalize(mesh.normals[t[2]]);
    return dot(geometric, sum) < 0.0f;
}

template <typename T>
void append_again(std::vector<T>& values, uint vertex) {
    if (!values.empty()) {
        values.push_back(T(values[vertex]));
    }
}

/// Adds a vertex like another one and returns its index.
uint doubled_vertex(Mesh& mesh, uint vertex) {
    append_again(mesh.positions, vertex);
    append_again(mesh.normals, vertex);
    append_again(mesh.uvs, vertex);
    append_again(mesh.second_uvs, vertex);
    append_again(mesh.colors, vertex);
    return static_cast<uint>(mesh.positions.size() - 1);
}

}  // namespace

std::vector<bool> triangles_against_normals(const Mesh& mesh) {
    std::vector<bool> against;
    if (mesh.normals.empty() || std::ranges::none_of(mesh.triangles, [&](const Corners& triangle) {
            return is_against_normals(mesh, triangle);
        })) {
        return against;
    }
    for (const Corners& triangle : mesh.triangles) {
        against.push_back(is_against_normals(mesh, triangle));
    }
    return against;
}

void turn_normals(Mesh& mesh, const std::vector<bool>& triangles) {
    if (triangles.empty()) {
        return;
    }
    std::vector<bool> is_kept(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const uint vertex : mesh.triangles[i]) {
            is_kept[vertex] = is_kept[vertex] || !triangles[i];
        }
    }
    constexpr uint kNone = ~0u;
    std::vector<uint> turned(mesh.positions.size(), kNone);  // where each vertex has its normal turned
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (uint& vertex : mesh.triangles[i]) {
            if (!triangles[i]) {
                continue;
            }
            uint& other = turned[vertex];
            if (other == kNone) {
                other = is_kept[vertex] ? doubled_vertex(mesh, vertex) : vertex;
                mesh.normals[other] = -mesh.normals[other];
            }
            vertex = other;
        }
    }
}

}  // namespace nearlight::core::gltf
