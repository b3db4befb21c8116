// SPDX-License-Identifier: Apache-2.0
#include "host/scene/crease_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace nearlight::core {
namespace {

constexpr uint kNoSet = ~0u;
/// How many triangles at one side are compared with each other. Surfaces have two there.
constexpr std::size_t kMaxTogether = 8;

/// Sets of corners that have a normal in common. Corner 3·t + k is that of triangle t at its vertex k.
class CornerSets {
  public:
    explicit CornerSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    uint find(uint corner) {
        while (parents_[corner] != corner) {
            corner = parents_[corner] = parents_[parents_[corner]];
        }
        return corner;
    }
    /// The smaller number stands for both sets, so that the result does not depend on the order.
    void join(uint a, uint b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint> parents_;
};

/// A side of a triangle: the numbers of the places at its ends, the smaller one first, and the triangle's
/// corners there.
struct Side {
    uint low_place, high_place;
    uint low_corner, high_corner;

    [[nodiscard]] bool is_at(const Side& other) const {
        return low_place == other.low_place && high_place == other.high_place;
    }
    bool operator<(const Side& other) const {
        return std::tie(low_place, high_place, low_corner) <
               std::tie(other.low_place, other.high_place, other.low_corner);
    }
};

/// The sides of all triangles that have an area and are not flat, those at the same places one after the
/// other.
std::vector<Side> sides_of(const Mesh& mesh, std::span<const uint> places, std::span<const uint> groups,
                           std::span<const Vec3> face_normals) {
    std::vector<Side> sides;
    for (uint t = 0; t < mesh.triangles.size(); ++t) {
        for (uint k = 0; k < 3 && groups[t] != kFlat && !is_zero(face_normals[t]); ++k) {
            Side side{.low_place = places[mesh.triangles[t][k]],
                      .high_place = places[mesh.triangles[t][(k + 1) % 3]],
                      .low_corner = 3 * t + k,
                      .high_corner = 3 * t + (k + 1) % 3};
            if (side.low_place > side.high_place) {
                std::swap(side.low_place, side.high_place);
                std::swap(side.low_corner, side.high_corner);
            }
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

std::vector<Vec3> face_normals_of(const Mesh& mesh) {
    std::vector<Vec3> normals;
    normals.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 normal =
            normalize(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
        normals.push_back(is_finite(normal) ? normal : Vec3{0, 0, 0});
    }
    return normals;
}

CornerSets joined_corners(const Mesh& mesh, std::span<const uint> places, std::span<const uint> groups,
                          std::span<const Vec3> face_normals, float crease_degrees) {
    const float min_cosine = std::cos(crease_degrees * kPi / 180.0f);
    const auto is_smooth = [&](uint a, uint b) {
        return groups[a] == groups[b] &&
               (groups[a] != kSmoothByAngle || dot(face_normals[a], face_normals[b]) > min_cosine);
    };
    CornerSets sets(3 * mesh.triangles.size());
    const std::vector<Side> sides = sides_of(mesh, places, groups, face_normals);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Side& a = sides[i];
        const std::size_t end = std::min(sides.size(), i + kMaxTogether);
        for (std::size_t j = i + 1; j < end && a.is_at(sides[j]); ++j) {
            if (is_smooth(a.low_corner / 3, sides[j].low_corner / 3)) {
                sets.join(a.low_corner, sides[j].low_corner);
                sets.join(a.high_corner, sides[j].high_corner);
            }
        }
    }
    return sets;
}

/// The angle of the triangle at the corner.
float angle_at(const Mesh& mesh, uint corner) {
    const auto& t = mesh.triangles[corner / 3];
    const Vec3 at = mesh.positions[t[corner % 3]];
    const Vec3 a = normalize(mesh.positions[t[(corner + 1) % 3]] - at);
    const Vec3 b = normalize(mesh.positions[t[(corner + 2) % 3]] - at);
    return std::acos(std::clamp(dot(a, b), -1.0f, 1.0f));
}

/// Makes the vertices that corners of different sets need.
class VertexSplitter {
  public:
    /// The vertex of a set of corners that has all but the normal from the mesh's vertex.
    uint vertex(uint set, uint from, Vec3 normal) {
        const auto [known, is_new] =
            made_.try_emplace(std::uint64_t{set} << 32 | from, static_cast<uint>(from_.size()));
        if (is_new) {
            from_.push_back(from);
            normals_.push_back(normal);
        }
        return known->second;
    }

    /// Values of the mesh's vertices for those that were made.
    template <typename T>
    [[nodiscard]] std::vector<T> spread(const std::vector<T>& values) const {
        std::vector<T> result;
        for (const uint from : values.empty() ? std::span<const uint>{} : std::span(from_)) {
            result.push_back(values[from]);
        }
        return result;
    }
    [[nodiscard]] const std::vector<Vec3>& normals() const { return normals_; }

  private:
    std::unordered_map<std::uint64_t, uint> made_;
    std::vector<uint> from_;
    std::vector<Vec3> normals_;
};

}  // namespace

void add_crease_normals(Mesh& mesh, std::span<const uint> places, std::span<const uint> groups,
                        float crease_degrees) {
    const auto corners = static_cast<uint>(3 * mesh.triangles.size());
    const std::vector<Vec3> face_normals = face_normals_of(mesh);
    CornerSets sets = joined_corners(mesh, places, groups, face_normals, crease_degrees);
    std::vector<Vec3> normals(corners, Vec3{0, 0, 0});
    for (uint corner = 0; corner < corners; ++corner) {
        if (groups[corner / 3] != kFlat && !is_zero(face_normals[corner / 3])) {
            normals[sets.find(corner)] += face_normals[corner / 3] * angle_at(mesh, corner);
        }
    }
    VertexSplitter splitter;
    std::vector<std::array<uint, 3>> triangles(mesh.triangles.size());
    for (uint corner = 0; corner < corners; ++corner) {
        // Flat triangles share their vertices, as if all their corners were one set.
        const bool is_flat = groups[corner / 3] == kFlat;
        const uint set = is_flat ? kNoSet : sets.find(corner);
        const Vec3 normal = is_flat || is_zero(normals[set]) ? Vec3{0, 0, 0} : normalize(normals[set]);
        triangles[corner / 3][corner % 3] =
            splitter.vertex(set, mesh.triangles[corner / 3][corner % 3], normal);
    }
    mesh.positions = splitter.spread(mesh.positions);
    mesh.uvs = splitter.spread(mesh.uvs);
    mesh.second_uvs = splitter.spread(mesh.second_uvs);
    mesh.colors = splitter.spread(mesh.colors);
    mesh.normals = splitter.normals();
    mesh.triangles = std::move(triangles);
}

}  // namespace nearlight::core
