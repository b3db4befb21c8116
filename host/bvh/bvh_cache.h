// SPDX-License-Identifier: Apache-2.0
// A cache of trees on disk, so that a second render of the same geometry does not build them.
#pragma once

#include <cstdint>
#include <filesystem>

#include "host/bvh/shaped_bvh.h"

namespace nearlight::core {

struct BvhCacheConfig {
    std::filesystem::path folder;          ///< "" and "none" keep nothing
    std::size_t min_triangles = 20'000;    ///< trees of smaller scenes are built faster than looked up
    std::uintmax_t max_bytes = 1u << 30u;  ///< size of all files; the least recently used are removed
};

/// Returns what build_scene_tree() makes, bit by bit. It comes from the cache if that has a tree of the same
/// vertices, triangles, `config` and `shapes`; otherwise it is built and kept. A damaged file counts as
/// missing, and a failure to write is no error. A file has 40 bytes a triangle and shape.
ShapedBvh find_or_build_scene_tree(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes,
                                   const BvhCacheConfig& cache);

}  // namespace nearlight::core
