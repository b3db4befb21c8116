// SPDX-License-Identifier: Apache-2.0
// Closed shapes with outward normals; texture coordinates are metres unless said otherwise.
#pragma once

#include <functional>

#include "scenes/generator/curves.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// Stands on y = 0, centred in x and z, with rounded edges. u runs along the longer side of each face, in
/// metres.
Mesh box(Vec3 size, float bevel = 0.003f, int segments = 2);
/// The profile turned about the y axis; u is the turn, v the place along the profile, both in [0, 1].
Mesh lathe(const Profile& profile, int segments);
/// Stands on y = 0.
Mesh cylinder(float radius, float height, float bevel = 0.002f, int segments = 48);
Mesh ellipsoid(Vec3 radii, int segments = 48);
/// About the y axis, centred at the origin.
Mesh torus(float radius, float tube, int segments = 64, int tube_segments = 16);

struct TubeShape {
    std::vector<float> radii{0.01f};  ///< spread evenly along the curve, interpolated linearly
    float flatness = 1.0f;            ///< height of the cross section over its width
    int sides = 16;
    bool facets = false;
};
/// A tube with round ends along an open curve.
Mesh tube(const Curve& curve, const TubeShape& shape);

/// A thin solid sheet about the surface p(u, v), (u, v) in [0, 1]², which are its texture coordinates too.
/// dp/dv × dp/du is its upper side.
Mesh sheet(const std::function<Vec3(float, float)>& surface, int u_steps, int v_steps, float thickness);

/// Parts of the mesh whose triangles' centres satisfy `inside`, and the others.
std::pair<Mesh, Mesh> split(const Mesh& mesh, const std::function<bool(Vec3)>& inside);

}  // namespace nearlight::core::scenes
