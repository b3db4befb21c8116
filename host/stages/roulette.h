// SPDX-License-Identifier: Apache-2.0
// Russian roulette over the VPLs of a gather, which traces few rays to VPLs that could bring little light.
// The kernels are in roulette.cl.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/vpl_selection.h"
#include "host/stages/vpl_strata.h"

namespace nearlight::core {

struct RouletteTask {
    const Buffer<Vpl>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    const VplStrata* strata = nullptr;  ///< those of the gather; null means the whole set
    float clamp_radius = 0.0f;          ///< R of the bounded geometry term, m
    /// A bundle always asks about a VPL that could bring its receivers at least `threshold` times the mean
    /// over all VPLs of its stratum, and about other VPLs with a probability in proportion to what they could
    /// bring. That is the root mean square of unoccluded light. Must be above 0.
    float threshold = 1.0f;
    uint seed = 0;
};

class Roulette {
  public:
    explicit Roulette(Device& device);

    /// Makes the lists of VPLs that the task's bundles draw; each VPL in a list has the weight 1/p, times the
    /// number of strata. The selection refers to the stage and to what the task refers to.
    [[nodiscard]] VplSelection select(const RouletteTask& task);

  private:
    [[nodiscard]] const VplStrata& strata_of(const RouletteTask& task) const {
        return task.strata != nullptr ? *task.strata : whole_set_;
    }
    const VplLists& choose(const RouletteTask& task, std::size_t first_bundle, std::size_t end_bundle);

    Device* device_;
    Program program_;
    Kernel bounds_kernel_;
    Kernel choose_kernel_;
    Buffer<float> bounds_;
    VplLists lists_;
    VplStrata whole_set_;  ///< in place of strata
};

}  // namespace nearlight::core
