// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mesh.h"

#include <algorithm>
#include <map>
#include <utility>

#include "host/scene/places.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

using Indices = std::array<uint, 3>;

Vec3 unit_direction(const std::array<double, 3>& v) {
    const double l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(l > 0.0) || !std::isfinite(l)) {
        return {0, 0, 0};
    }
    return {static_cast<float>(v[0] / l), static_cast<float>(v[1] / l), static_cast<float>(v[2] / l)};
}

std::vector<Vec3> world_normals(const Mesh& mesh, const MeshPlacement& placement,
                                std::span<const Vec3> positions) {
    if (placement.face_normals) {
        return {};
    }
    if (mesh.normals.empty()) {
        return smooth_normals(positions, mesh.triangles);
    }
    const double sign = linear_determinant(placement.to_world) < 0.0 ? -1.0 : 1.0;
    std::vector<Vec3> normals;
    normals.reserve(mesh.normals.size());
    for (const Vec3 n : mesh.normals) {
        normals.push_back(transform_normal(placement.to_world, sign, n));
    }
    return normals;
}

// Makes room for one of many meshes. With exactly the room needed, each mesh would move all earlier ones.
template <typename T>
void make_room(std::vector<T>& values, std::size_t more) {
    if (values.size() + more > values.capacity()) {
        values.reserve(std::max(values.size() + more, 2 * values.capacity()));
    }
}

// Vertices that no kept triangle uses may still be NaN; nothing reads them, but they must not spoil hashes.
void append_vertices(Scene& scene, const Mesh& mesh, std::span<const Vec3> positions,
                     std::span<const Vec3> normals, bool flip) {
    make_room(scene.vertices, positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Vertex vertex{};
        vertex.position = is_finite(positions[i]) ? positions[i] : Vec3{0, 0, 0};
        if (!normals.empty()) {
            vertex.normal = flip ? -normals[i] : normals[i];
        }
        if (!mesh.uvs.empty() && std::isfinite(mesh.uvs[i][0]) && std::isfinite(mesh.uvs[i][1])) {
            vertex.u = mesh.uvs[i][0];
            vertex.v = mesh.uvs[i][1];
        }
        scene.vertices.push_back(vertex);
    }
}

// Keeps one colour a vertex as soon as any mesh has colours.
void append_colors(Scene& scene, const Mesh& mesh) {
    if (mesh.colors.empty() && scene.vertex_colors.empty()) {
        return;
    }
    make_room(scene.vertex_colors, scene.vertices.size() - scene.vertex_colors.size());
    scene.vertex_colors.resize(scene.vertices.size() - mesh.positions.size(), kNoColor);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const bool is_known = !mesh.colors.empty() && is_finite(mesh.colors[i]);
        scene.vertex_colors.push_back(is_known ? max(mesh.colors[i], {0, 0, 0}) : kNoColor);
    }
}

// Keeps second texture coordinates of all vertices as soon as any mesh has them.
void append_second_uvs(Scene& scene, const Mesh& mesh) {
    if (mesh.second_uvs.empty() && scene.second_uvs.empty()) {
        return;
    }
    make_room(scene.second_uvs, scene.vertices.size() - scene.second_uvs.size());
    scene.second_uvs.resize(scene.vertices.size() - mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const bool is_known = !mesh.second_uvs.empty() && std::isfinite(mesh.second_uvs[i][0]) &&
                              std::isfinite(mesh.second_uvs[i][1]);
        scene.second_uvs.push_back(is_known ? mesh.second_uvs[i] : std::array<float, 2>{0, 0});
    }
}

/// Begins the objects of a mesh in the scene, whose names its own come after.
class ObjectCopier {
  public:
    ObjectCopier(Scene& scene, const Mesh& mesh)
        : scene_(scene), runs_(mesh.objects), first_name_(static_cast<uint>(scene.object_names.size())) {
        scene.object_names.insert(scene.object_names.end(), mesh.object_names.begin(),
                                  mesh.object_names.end());
    }
    /// Called before each triangle of the mesh, whether the scene gets it or not.
    void reach(std::size_t triangle) {
        for (; next_ < runs_.size() && runs_[next_].first_triangle <= triangle; ++next_) {
            scene_.objects.push_back(
                {static_cast<uint>(scene_.triangles.size()), first_name_ + runs_[next_].name});
        }
    }

  private:
    Scene& scene_;
    std::span<const ObjectRun> runs_;
    uint first_name_;
    std::size_t next_ = 0;
};

/// The values at the corners of the triangles, one after another; none if there are no values.
template <typename T>
std::vector<T> at_corners(std::span<const T> values, std::span<const Indices> triangles) {
    std::vector<T> corners;
    if (!values.empty()) {
        corners.reserve(3 * triangles.size());
        for (const Indices& triangle : triangles) {
            for (const uint vertex : triangle) {
                corners.push_back(values[vertex]);
            }
        }
    }
    return corners;
}

/// A mesh in the scene's coordinates.
struct PlacedMesh {
    Mesh mesh;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< empty for flat facets
};

/// The mesh with vertices of its own for each triangle, which have the colour of the face if there is one.
/// Normals remain those of the mesh whose triangles share vertices.
PlacedMesh split_faces(const Mesh& mesh, std::span<const Vec3> positions, std::span<const Vec3> normals) {
    const auto corners = [&](const auto& values) { return at_corners(std::span(values), mesh.triangles); };
    PlacedMesh split{.mesh = {}, .positions = corners(positions), .normals = corners(normals)};
    split.mesh.source = mesh.source;
    split.mesh.positions = corners(mesh.positions);
    split.mesh.normals = corners(mesh.normals);
    split.mesh.uvs = corners(mesh.uvs);
    split.mesh.second_uvs = corners(mesh.second_uvs);
    split.mesh.colors = mesh.face_colors.empty() ? corners(mesh.colors) : std::vector<Vec3>();
    split.mesh.object_names = mesh.object_names;
    split.mesh.objects = mesh.objects;
    split.mesh.groups = mesh.groups;
    for (uint i = 0; i < mesh.triangles.size(); ++i) {
        split.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        if (!mesh.face_colors.empty()) {
            split.mesh.colors.insert(split.mesh.colors.end(), 3, mesh.face_colors[i]);
        }
    }
    return split;
}

void append_placed(Scene& scene, const Mesh& mesh, std::span<const Vec3> positions,
                   std::span<const Vec3> normals, const MeshPlacement& placement, NoteSink& notes) {
    const bool own_normals = !placement.face_normals && !mesh.normals.empty();
    const auto first = static_cast<uint>(scene.vertices.size());
    append_vertices(scene, mesh, positions, normals, placement.flip_normals);
    append_colors(scene, mesh);
    append_second_uvs(scene, mesh);

    ObjectCopier objects(scene, mesh);
    std::size_t dropped = 0;
    make_room(scene.triangles, mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        objects.reach(i);
        Indices t = mesh.triangles[i];
        if (!is_finite(positions[t[0]]) || !is_finite(positions[t[1]]) || !is_finite(positions[t[2]])) {
            ++dropped;
            continue;
        }
        if ((own_normals && winds_against(t, positions, normals)) != placement.flip_normals) {
            std::swap(t[1], t[2]);
        }
        const uint material = placement.materials[mesh.groups.empty() ? 0 : mesh.groups[i]];
        scene.triangles.push_back({first + t[0], first + t[1], first + t[2], material});
    }
    if (dropped > 0) {
        notes.approximation(mesh.source, 0,
                            std::to_string(dropped) + " triangles with NaN or infinite corners are left out");
    }
}

}  // namespace

bool winds_against(const std::array<uint, 3>& t, std::span<const Vec3> positions,
                   std::span<const Vec3> normals) {
    const Vec3 geometric = cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
    return dot(geometric, normals[t[0]] + normals[t[1]] + normals[t[2]]) < 0.0f;
}

// The cofactor matrix serves where the inverse transpose does, and also where the transform flattens space.
Vec3 transform_normal(const Mat4& m, double sign, Vec3 n) {
    const auto cofactor = [&](int r, int c) {
        const int r1 = (r + 1) % 3;
        const int r2 = (r + 2) % 3;
        const int c1 = (c + 1) % 3;
        const int c2 = (c + 2) % 3;
        return m(r1, c1) * m(r2, c2) - m(r1, c2) * m(r2, c1);
    };
    const auto row = [&](int r) {
        return sign * (cofactor(r, 0) * n.x + cofactor(r, 1) * n.y + cofactor(r, 2) * n.z);
    };
    return unit_direction({row(0), row(1), row(2)});
}

std::vector<Vec3> smooth_normals(std::span<const Vec3> positions, std::span<const Indices> triangles) {
    std::vector<Vec3> normals(positions.size(), Vec3{0, 0, 0});
    for (const Indices& t : triangles) {
        const Vec3 normal =
            normalize(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]));
        if (!is_finite(normal)) {
            continue;
        }
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 a = normalize(positions[t[(corner + 1) % 3]] - positions[t[corner]]);
            const Vec3 b = normalize(positions[t[(corner + 2) % 3]] - positions[t[corner]]);
            normals[t[corner]] += normal * std::acos(std::clamp(dot(a, b), -1.0f, 1.0f));
        }
    }
    for (Vec3& normal : normals) {
        normal = normalize(normal);
    }
    return normals;
}

bool is_closed(const Mesh& mesh, std::optional<uint> group) {
    Places places;
    const auto place = [&](uint vertex) { return places.number(mesh.positions[vertex]); };
    std::map<std::pair<uint, uint>, int> open_edges;  // how much more often one way than the other
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (group && (mesh.groups.empty() ? 0 : mesh.groups[i]) != *group) {
            continue;
        }
        const auto& [a, b, c] = mesh.triangles[i];
        const std::array corners{place(a), place(b), place(c)};
        for (std::size_t k = 0; k < 3; ++k) {
            const uint from = corners[k];
            const uint to = corners[(k + 1) % 3];
            open_edges[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    }
    return std::ranges::all_of(open_edges, [](const auto& edge) { return edge.second == 0; });
}

void check_mesh(const Mesh& mesh) {
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::file, mesh.source.string() + ": " + what);
    };
    if ((!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) ||
        (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()) ||
        (!mesh.second_uvs.empty() && mesh.second_uvs.size() != mesh.positions.size()) ||
        (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size())) {
        fail("the numbers of normals, colours or texture coordinates differ from the number of vertices");
    }
    if (!mesh.face_colors.empty() && mesh.face_colors.size() != mesh.triangles.size()) {
        fail("the number of faces' colours differs from the number of triangles");
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const uint index : mesh.triangles[i]) {
            if (index >= mesh.positions.size()) {
                fail("triangle " + std::to_string(i) + " uses vertex " + std::to_string(index) +
                     ", but there are only " + std::to_string(mesh.positions.size()));
            }
        }
    }
}

void append_mesh(Scene& scene, const Mesh& mesh, const MeshPlacement& placement, NoteSink& notes) {
    check_mesh(mesh);
    check_triangle_count(scene.triangles.size() + mesh.triangles.size());
    std::vector<Vec3> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3 p : mesh.positions) {
        positions.push_back(transform_point(placement.to_world, p));
    }
    const std::vector<Vec3> normals = world_normals(mesh, placement, positions);
    if (mesh.face_colors.empty() && !placement.corner_uvs) {
        append_placed(scene, mesh, positions, normals, placement, notes);
        return;
    }
    PlacedMesh split = split_faces(mesh, positions, normals);
    if (placement.corner_uvs) {
        // Mitsuba's v goes down the rows of a texture.
        constexpr std::array<std::array<float, 2>, 3> kCorners{{{0, 1}, {1, 1}, {0, 0}}};
        for (std::size_t i = 0; i < split.positions.size(); ++i) {
            split.mesh.uvs.push_back(kCorners.at(i % 3));
        }
    }
    append_placed(scene, split.mesh, split.positions, split.normals, placement, notes);
}

}  // namespace nearlight::core
