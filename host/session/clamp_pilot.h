// SPDX-License-Identifier: Apache-2.0
// The choice of the clamp radius R for a set of VPLs, by a pilot. The picture's expectation does not depend
// on R, because rays of receivers bring what the bounded geometry term takes away. Its noise does: with a
// small R, VPLs close to a receiver are outliers, and with a large one, rays bring much of the light.
#pragma once

#include "host/samplers/sampler.h"
#include "host/session/band_renderer.h"

namespace nearlight::core {

/// What the pilot works on. Everything is on the device of `stages`.
struct ClampPilot {
    BandStages& stages;
    const DeviceScene& scene;
    const PilotView& view;    ///< its receivers stand for those of the picture
    const VplBuffer& vpls;    ///< one or more
    uint max_edges = 1;       ///< of a path from a light to a receiver that the camera sees directly
    uint rays_per_pixel = 1;  ///< rays of receivers, on which the choice is to be based
    uint seed = 0;
};

/// Returns the multiple of `radius` (m) by a power of two, from 1/4 to 4, that is expected to give the least
/// mean squared error, each receiver's relative to its light. For each candidate, the pilot gathers all VPLs
/// at the view's receivers, which gives the VPLs' part of the error as the sum of their squares, and sends
/// two rays from each receiver, whose difference gives the rays' part. The result depends on no timing.
float choose_clamp_radius(const ClampPilot& pilot, float radius);

}  // namespace nearlight::core
