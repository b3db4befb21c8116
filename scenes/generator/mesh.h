// SPDX-License-Identifier: Apache-2.0
// Triangle meshes of the scene generator, in metres with +Y up. Triangles are counter-clockwise seen from
// outside.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "host/base/math.h"

namespace nearlight::core::scenes {

struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<std::array<uint, 3>> triangles;

    uint add_vertex(Vec3 position, Vec3 normal, float u = 0.0f, float v = 0.0f);
    /// Adds a triangle unless two of its corners are at the same place, as at the poles of lathes and tubes.
    void add_triangle(uint a, uint b, uint c);
    void add_quad(uint a, uint b, uint c, uint d);
    Mesh& append(const Mesh& other);
};

Mesh operator+(Mesh a, const Mesh& b);
/// The mesh transformed by the matrix. If the matrix mirrors, triangles are turned over so that their fronts
/// stay outside.
Mesh transformed(Mesh mesh, const Mat4& matrix);
Mesh moved(Mesh mesh, Vec3 offset);
Mesh turned(Mesh mesh, Vec3 axis, float degrees);
Mesh scaled(Mesh mesh, Vec3 factors);
/// The mesh with one normal per triangle.
Mesh faceted(const Mesh& mesh);
/// The mesh with normals that are the area-weighted means over all corners at the same place.
Mesh smoothed(Mesh mesh);
/// The mesh with every vertex moved along its normal by `amplitude` (m) times noise of the given frequency
/// (1/m).
Mesh roughened(Mesh mesh, float amplitude, float frequency);
Aabb bounds(const Mesh& mesh);

/// An object of several materials. It has one mesh per part, and the part's name becomes the file name.
class Model {
  public:
    Model() = default;
    Model(const std::string& part, const Mesh& mesh) { add(part, mesh); }

    void add(const std::string& part, const Mesh& mesh) { parts_[part].append(mesh); }
    void add(const Model& other, const Mat4& placement = Mat4{});
    /// Adds a model that is turned about the vertical, then moved.
    void place(const Model& other, Vec3 position, float degrees = 0.0f);

    [[nodiscard]] const std::map<std::string, Mesh>& parts() const { return parts_; }

  private:
    std::map<std::string, Mesh> parts_;
};

}  // namespace nearlight::core::scenes
