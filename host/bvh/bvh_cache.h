// SPDX-License-Identifier: Apache-2.0
// Trees on disk, so that a second render of the same geometry does not build them.
#pragma once

#include <cstdint>
#include <filesystem>

#include "host/bvh/scene_trees.h"

namespace nearlight::core {

struct BvhCacheConfig {
    std::filesystem::path folder;          ///< "" and "none" keep nothing
    std::size_t min_triangles = 20'000;    ///< smaller scenes are built faster than they are looked up
    std::uintmax_t max_bytes = 1u << 30u;  ///< of all trees; those that were not used for longest go
};

/// What build_scene_trees() gives, bit by bit: from the cache if it has the trees of the same vertices,
/// triangles, choice of glass, `config` and `shapes`, else built and kept. Damaged files count as missing,
/// and failing to write is no error. 40 bytes a triangle and shape on disk.
SceneTrees find_or_build_scene_trees(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes,
                                     const BvhCacheConfig& cache);

}  // namespace nearlight::core
