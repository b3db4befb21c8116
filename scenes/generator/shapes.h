// SPDX-License-Identifier: Apache-2.0
// Closed shapes with outward normals; texture coordinates are in metres unless a comment says otherwise.
#pragma once

#include <functional>

#include "scenes/generator/curves.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A box with rounded edges that stands on y = 0, centred in x and z. u runs along the longer side of each
/// face, in metres.
Mesh box(Vec3 size, float bevel = 0.003f, int segments = 2);
/// The solid of revolution of a profile about the y axis. u is the turn, v the place along the profile, both
/// in [0, 1].
Mesh lathe(const Profile& profile, int segments);
/// A cylinder that stands on y = 0.
Mesh cylinder(float radius, float height, float bevel = 0.002f, int segments = 48);
Mesh ellipsoid(Vec3 radii, int segments = 48);
/// A torus about the y axis, centred at the origin.
Mesh torus(float radius, float tube, int segments = 64, int tube_segments = 16);

struct TubeShape {
    std::vector<float> radii{0.01f};  ///< radii at even steps along the curve, interpolated linearly
    float flatness = 1.0f;            ///< height of the cross section over its width
    int sides = 16;
    bool facets = false;
};
/// A tube with round ends along an open curve.
Mesh tube(const Curve& curve, const TubeShape& shape);

/// A thin solid sheet about the surface p(u, v). Its texture coordinates are (u, v) in [0, 1]², and its upper
/// side faces dp/dv × dp/du.
Mesh sheet(const std::function<Vec3(float, float)>& surface, int u_steps, int v_steps, float thickness);

/// Two meshes: the triangles whose centres satisfy `inside`, and the others.
std::pair<Mesh, Mesh> split(const Mesh& mesh, const std::function<bool(Vec3)>& inside);

}  // namespace nearlight::core::scenes
