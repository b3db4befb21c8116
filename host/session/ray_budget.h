// SPDX-License-Identifier: Apache-2.0
// The choice of the clamp radius R for a set of VPLs, of the number of light samples, of how much light of
// one path a bundle shares, and of whether receivers aim at mirrors and glass, by a pilot. The picture's
// expectation does not depend on them, because rays of receivers bring what the bounded geometry term takes
// away. Its noise does: with a small R, VPLs close to a receiver are outliers, and with a large one, rays
// bring much of the light.
#pragma once

#include "host/samplers/sampler.h"
#include "host/session/band_renderer.h"

namespace nearlight::core {

/// What the pilot works on. Everything is on the device of `stages`.
struct BudgetPilot {
    BandStages& stages;
    const DeviceScene& scene;
    const PilotView& view;        ///< its receivers stand for those of the picture
    const VplBuffer& vpls;        ///< one or more: the set, or a few of it, which stand for all
    std::size_t asked_count = 0;  ///< VPLs that a pixel asks about with cuts; 0: no cuts
    std::size_t set_count = 0;    ///< the VPLs of the set
    uint max_edges = 1;           ///< of a path from a light to a receiver that the camera sees directly
    float clamp_radius = 0;       ///< m, where the choice starts
    uint rays_per_pixel = 1;      ///< rays of receivers, on which the choice is to be based
    bool radius_is_open = false;  ///< whether the radius may be chosen
    uint seed = 0;
};

/// Returns the budget that is expected to need the least time for a given mean squared error, each receiver's
/// relative to its light. The error of VPLs counts more than that of rays, because neighbouring pixels share
/// it. Candidates are 16 to 128 light samples, and, if the radius is open, its multiples by a power of two
/// from 1/4 to 4. For each radius, the pilot gathers its VPLs at the view's receivers, which gives the VPLs'
/// part of the error as the sum of their squares, and takes two light samples and two rays at each receiver,
/// whose differences give the parts of both. Where the scene has caustic aims, receivers aim as many rays (1,
/// 4 or 16) as lessen the error by most for what they cost, or none. What rays cost is counted in units of a
/// typical device, so the result depends on no timing.
RayBudget choose_ray_budget(const BudgetPilot& pilot);

}  // namespace nearlight::core
