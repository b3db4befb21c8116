// SPDX-License-Identifier: Apache-2.0
// The animations of a file, which move its nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core::gltf {

/// Gives the nodes the translations, rotations, scales and weights of morph targets that they have at that
/// moment. Returns the time from the first to the last key. Calls fail() if a played animation is broken;
/// throws Error(ErrorKind::invalid_argument) if the file has no animations, for animations that are not
/// there, and for those that move the same node in the same way.
TimeSpan pose_nodes(GltfFile& file, const SceneMoment& moment, NoteSink& notes);

/// The animations of the file. What pose_nodes() would say of a broken one is its fault.
std::vector<SceneAnimation> list_animations(const GltfFile& file);

/// A hash of where nodes with surfaces and lights stand, how surfaces are bent, and nothing else: scenes of
/// one file with equal hashes differ in their camera only.
std::uint64_t pose_hash(const GltfFile& file, const std::vector<PlacedNode>& nodes);

}  // namespace nearlight::core::gltf
