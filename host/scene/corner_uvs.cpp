// SPDX-License-Identifier: Apache-2.0
#include "host/scene/corner_uvs.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace nearlight::core {
namespace {

/// A corner of a triangle; `index` is 3·t + k for triangle t at its vertex k.
struct UvCorner {
    uint vertex;
    std::array<float, 2> uv;
    uint index;

    [[nodiscard]] bool shares_vertex(const UvCorner& other) const {
        return vertex == other.vertex && uv == other.uv;
    }
};

/// The corners of all triangles, those that share a vertex one after another.
std::vector<UvCorner> sorted_corners(const Mesh& mesh, std::span<const std::array<float, 2>> uvs) {
    std::vector<UvCorner> corners;
    corners.reserve(uvs.size());
    for (uint i = 0; i < uvs.size(); ++i) {
        corners.push_back({mesh.triangles[i / 3][i % 3], uvs[i], i});
    }
    std::ranges::sort(corners, {},
                      [](const UvCorner& corner) { return std::pair(corner.vertex, corner.uv); });
    return corners;
}

/// The values of the vertices `from`; none if there are no values.
template <typename T>
std::vector<T> values_of(const std::vector<T>& values, std::span<const uint> from) {
    std::vector<T> result;
    result.reserve(values.empty() ? 0 : from.size());
    for (const uint vertex : values.empty() ? std::span<const uint>{} : from) {
        result.push_back(values[vertex]);
    }
    return result;
}

}  // namespace

void set_corner_uvs(Mesh& mesh, std::span<const std::array<float, 2>> uvs) {
    const std::vector<UvCorner> corners = sorted_corners(mesh, uvs);
    std::vector<uint> from;
    mesh.uvs.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const UvCorner& corner = corners[i];
        if (i == 0 || !corner.shares_vertex(corners[i - 1])) {
            from.push_back(corner.vertex);
            mesh.uvs.push_back(corner.uv);
        }
        mesh.triangles[corner.index / 3][corner.index % 3] = static_cast<uint>(from.size() - 1);
    }
    mesh.positions = values_of(mesh.positions, from);
    mesh.normals = values_of(mesh.normals, from);
    mesh.second_uvs = values_of(mesh.second_uvs, from);
    mesh.colors = values_of(mesh.colors, from);
}

}  // namespace nearlight::core
