// SPDX-License-Identifier: Apache-2.0
// The work of a gather in a scene, made by plain host code: receivers and VPLs as a renderer would have them,
// and the rays that find them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Receivers at what the camera sees through the centre of each pixel. A packet is a tile of 8 × 8 pixels in
/// Morton order. Normals are geometric and point to the camera's side. Receivers of pixels that see nothing
/// or lie outside the picture are absent.
std::vector<ReceiverPacket> make_camera_receivers(const Scene& scene, const Bvh& bvh, int width, int height);

/// `count` VPLs in Morton order, deposited by walks from the scene's lights with at most five bounces. In a
/// scene without point, spot and area lights they are spread evenly over all surfaces.
std::vector<Vpl> make_traced_vpls(const Scene& scene, const Bvh& bvh, std::size_t count,
                                  std::uint64_t seed = 1);

/// The rays that find the receivers of make_camera_receivers(), in the same order: unit directions, t from 0
/// to infinity.
std::vector<RayQuery> make_camera_rays(const Scene& scene, int width, int height);

/// The first `count` rays of the walks of make_traced_vpls(), walk by walk, including rays that leave the
/// scene. In a scene without point, spot and area lights they start at points on all surfaces.
std::vector<RayQuery> make_walk_rays(const Scene& scene, const Bvh& bvh, std::size_t count,
                                     std::uint64_t seed = 1);

/// Sorts the VPLs along the Morton curve through the bounds of the scene.
void sort_along_morton_curve(const Scene& scene, std::vector<Vpl>& vpls);

}  // namespace nearlight::core
