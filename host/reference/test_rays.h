// SPDX-License-Identifier: Apache-2.0
// Triangles and rays of every awkward kind, for comparisons of ray casters.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Small random triangles within about [−1, 1]³. Some lie in axis-aligned planes, and some degenerate to
/// lines or points.
Scene make_triangle_soup(std::size_t triangle_count, std::uint64_t seed);

struct RayFamily {
    std::string name;
    std::vector<RayQuery> rays;
    /// Whether rays meet edges by design, so that both answers are right for many of them.
    bool meets_edges = false;
};

/// Families of about `count` rays each: random rays, some of them short; axis-aligned rays with zeros of both
/// signs; and grazing rays, through vertices, along edges and within the planes of the scene's triangles.
std::vector<RayFamily> make_ray_families(const Scene& scene, std::size_t count, std::uint64_t seed);

/// Rays with a NaN or infinite component, a zero direction, or an empty interval. None of them hits anything.
std::vector<RayQuery> make_broken_rays();

}  // namespace nearlight::core
