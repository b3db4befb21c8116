// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/front_normals.h"

#include <algorithm>
#include <iterator>

namespace nearlight::core::gltf {
namespace {

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
    if (mesh.normals.empty()) {
        return {};
    }
    std::vector<Vec3> normals;
    std::ranges::transform(mesh.normals, std::back_inserter(normals), [](Vec3 n) { return normalize(n); });
    std::vector<bool> against;
    for (const auto& triangle : mesh.triangles) {
        against.push_back(winds_against(triangle, mesh.positions, normals));
    }
    return std::ranges::find(against, true) == against.end() ? std::vector<bool>() : against;
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
