// SPDX-License-Identifier: Apache-2.0
// Normals for meshes of files that have none, or whose normals are to be made anew.
#pragma once

#include <span>

#include "host/scene/mesh.h"

namespace nearlight::core {

/// Groups of triangles for smoothing that have a meaning of their own.
inline constexpr uint kFlat = 0;
inline constexpr uint kSmoothByAngle = ~0u;

/// Unless a file says otherwise, triangles of kSmoothByAngle that meet at a greater angle than this, in
/// degrees, have a crease between them: facets of round things meet at less, walls and floors at more.
inline constexpr float kCreaseDegrees = 40.0f;

/// Gives a mesh normals of its own, in place of those that it may have: triangles of the same group that
/// share an edge are smooth across it, weighted by their angles as in smooth_normals(), and a vertex becomes
/// several where others meet. Vertices of kFlat get the normal (0, 0, 0), which stands for that of the
/// triangle. `places` are those of the vertices (places_of()), which tell what shares an edge whatever
/// texture coordinates are. `groups` has one for each triangle.
void add_crease_normals(Mesh& mesh, std::span<const uint> places, std::span<const uint> groups,
                        float crease_degrees = kCreaseDegrees);

}  // namespace nearlight::core
