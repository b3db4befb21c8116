// SPDX-License-Identifier: Apache-2.0
// What a gather has to do in a scene, made by plain host code: receivers and VPLs as a renderer would have
// them, and the rays that find them.
#pragma once

#include <cstdint>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// What the camera sees at the centre of each pixel: packets are tiles of 8 × 8 pixels in Morton order,
/// normals geometric, on the camera's side. Pixels that see nothing, or lie beyond the edge, are absent.
std::vector<ReceiverPacket> make_camera_receivers(const Scene& scene, const Bvh& bvh, int width, int height);

/// `count` VPLs in Morton order, deposited by light walks from the scene's lamps with at most five bounces;
/// spread evenly over all surfaces where no point, spot or area light is there.
std::vector<Vpl> make_traced_vpls(const Scene& scene, const Bvh& bvh, std::size_t count,
                                  std::uint64_t seed = 1);

/// The rays that find such receivers, in the same order: unit directions, from 0 to infinity.
std::vector<RayQuery> make_camera_rays(const Scene& scene, int width, int height);

/// The first `count` rays of such walks, walk by walk, also those that leave the scene. Where no lamp is
/// there, rays from points on all surfaces.
std::vector<RayQuery> make_walk_rays(const Scene& scene, const Bvh& bvh, std::size_t count,
                                     std::uint64_t seed = 1);

/// Along the Morton curve through the bounds of the scene.
void sort_along_morton_curve(const Scene& scene, std::vector<Vpl>& vpls);

}  // namespace nearlight::core
