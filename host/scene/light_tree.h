// SPDX-License-Identifier: Apache-2.0
// The tree of lights, by which kernels choose a light for a receiver [Conty Estévez & Kulla,
// Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018].
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Fewer lights need no tree.
inline constexpr std::size_t kMinTreeLights = 2;

/// Builds the tree of the entries [first, end) of the table of lights, which have a place, and writes
/// Emitter::tree_way of each. The tree is empty if there are none. No light is below more than
/// NEARLIGHT_MAX_LIGHT_TREE_DEPTH nodes.
std::vector<LightNode> build_light_tree(const Scene& scene, std::vector<Emitter>& emitters, uint first,
                                        uint end);

}  // namespace nearlight::core
