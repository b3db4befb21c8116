// SPDX-License-Identifier: Apache-2.0
// Cuts through a tree of VPLs: each bundle of receivers asks about the few VPLs of a large set that could
// bring it most. The kernels are in light_cuts.cl.
#pragma once

#include <vector>

#include "host/cl/kernel.h"
#include "host/stages/vpl_selection.h"
#include "host/stages/vpl_strata.h"
#include "kernels/shared/light_cut.h"

namespace nearlight::core {

/// A tree over VPLs in their order along the Morton curve. Level 0 stands on the VPLs, the last one has at
/// most NEARLIGHT_CUT_MAX_ROOTS nodes.
struct CutTree {
    Buffer<CutNode> nodes;
    std::vector<uint> first_nodes;  ///< the first node of each level, and last the number of nodes

    [[nodiscard]] uint leaf_count() const { return first_nodes[1]; }
    [[nodiscard]] uint first_root() const { return first_nodes[first_nodes.size() - 2]; }
    [[nodiscard]] uint root_count() const { return first_nodes.back() - first_root(); }
};

struct CutTask {
    const Buffer<Vpl>& vpls;
    const CutTree& tree;  ///< over these VPLs
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    /// The strata of the bundles. With cuts, all VPLs belong to every stratum: a bundle draws asked_count ÷
    /// strata VPLs, and bundles of different strata draw different ones.
    const VplStrata& strata;
    float clamp_radius = 0.0f;    ///< R of the bounded geometry term, m
    std::size_t asked_count = 0;  ///< VPLs that bundles of all strata ask about together
    uint seed = 0;
};

class LightCuts {
  public:
    explicit LightCuts(Device& device);

    /// Makes a tree over the first `vpl_count` VPLs, which must be at least one.
    CutTree make_tree(const Buffer<Vpl>& vpls, std::size_t vpl_count);

    /// Makes the lists of VPLs that the task's bundles draw. A VPL that is drawn with probability p has the
    /// weight 1/p. The selection refers to the stage and to what the task refers to.
    [[nodiscard]] VplSelection select(const CutTask& task);

  private:
    const VplLists& choose(const CutTask& task, std::size_t first_bundle, std::size_t end_bundle);

    Device* device_;
    Program program_;
    Kernel leaves_kernel_;
    Kernel level_kernel_;
    Kernel choose_kernel_;
    Buffer<CutParams> params_;
    Buffer<CutEntry> entries_;
    VplLists lists_;
};

}  // namespace nearlight::core
