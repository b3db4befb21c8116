// SPDX-License-Identifier: Apache-2.0
// Where receivers aim to find the light of lamps that mirrors and glass send to them
// (kernels/lib/caustic_aim.cl).
#pragma once

#include <span>
#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "kernels/shared/caustic_aims.h"

namespace nearlight::core {

/// Walks from lights over mirrors and glass.
class CausticWalks {
  public:
    explicit CausticWalks(Device& device);

    /// The landings of the walks [first_walk, first_walk + walk_count), in their order.
    std::vector<CausticLanding> run(const DeviceScene& scene, uint first_walk, uint walk_count, uint seed);

  private:
    Device* device_;
    Kernel caustic_walks_;
};

/// Targets by cells of space, as kernels look them up.
struct CausticCells {
    CausticTable table{};
    std::vector<CausticCell> entries;  ///< of the table
    std::vector<Vec3> targets;
};

/// Sorts the targets of landings into cells of all levels. A cell has the targets of landings up to half its
/// side beyond it, or an even choice of them if there are more than NEARLIGHT_MAX_CAUSTIC_TARGETS. Above
/// level 0, cells with few landings are left out: receivers there find the larger cell around them. All
/// landings must be there.
CausticCells sort_into_cells(std::span<const CausticLanding> landings, float scene_extent);

/// Makes walks until enough have landed over mirrors and glass, and sorts their targets into cells. There are
/// no cells if hardly any walk lands so. The same seed gives the same cells.
CausticAims find_caustic_aims(Device& device, const DeviceScene& scene, uint seed);

}  // namespace nearlight::core
