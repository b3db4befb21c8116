// SPDX-License-Identifier: Apache-2.0
// The tree of area lights, by which kernels choose a light for a receiver [Conty Estévez & Kulla,
// Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018].
#pragma once

#include <vector>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Fewer area lights than this are chosen by power, which is quicker.
inline constexpr std::size_t kMinTreeLights = 8;

/// Builds the tree of all area lights in the table of lights, and writes Emitter::tree_way of each.
/// The tree is empty if there are fewer than kMinTreeLights of them. Node 0 is the root, and the first child
/// of a node stands behind it. No leaf is deeper than NEARLIGHT_MAX_LIGHT_TREE_DEPTH.
std::vector<LightNode> build_light_tree(const Scene& scene, std::vector<Emitter>& emitters);

}  // namespace nearlight::core
