// SPDX-License-Identifier: Apache-2.0
// Triangles and rays of every awkward kind, for comparing ray casters.
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Small triangles within about [−1, 1]³; some lie in axis-aligned planes, some are lines or points.
Scene make_triangle_soup(std::size_t triangle_count, std::uint64_t seed);

struct RayFamily {
    std::string name;
    std::vector<RayQuery> rays;
    /// Rays may meet edges by design, so that different answers are right for many of them.
    bool meets_edges = false;
};

/// Random rays, short ones among them; axis-aligned ones with both zeros; grazing ones: through vertices,
/// along edges and within the planes of the scene's triangles. About `count` each.
std::vector<RayFamily> make_ray_families(const Scene& scene, std::size_t count, std::uint64_t seed);

/// Rays with NaN or infinity somewhere, without direction, or with an empty interval: none hits anything.
std::vector<RayQuery> make_broken_rays();

}  // namespace nearlight::core
