// SPDX-License-Identifier: Apache-2.0
// What the checks of chosen VPLs (the roulette and the cuts) have in common.
#pragma once

#include <vector>

#include "host/bvh/bvh.h"
#include "host/selftest/checks.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {

/// A room of spheres with VPLs and receivers, on a device.
struct SelectionCase {
    static constexpr float kClampRadius = 0.05f;

    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
    DeviceTree tree;
    Buffer<Vpl> vpl_buffer;
    Buffer<ReceiverPacket> receiver_buffer;

    /// A gather of the VPLs that are selected, or of all.
    [[nodiscard]] GatherInput<Vpl> input(const VplSelection* selection) const {
        return {.tree = tree,
                .vpls = vpl_buffer,
                .vpl_count = vpls.size(),
                .receivers = receiver_buffer,
                .packet_count = receivers.size(),
                .clamp_radius = kClampRadius,
                .selection = selection};
    }
};

/// With `vpl_count` VPLs in the order of the Morton curve.
SelectionCase make_selection_case(Device& device, uint vpl_count);

/// The mean of many gathers of parts of the VPLs. Receivers count by packets, because chance may pass over
/// the only VPLs that light one of them.
class SelectionMean {
  public:
    /// Gathers all VPLs.
    SelectionMean(Device& device, const SelectionCase& data);

    /// Gathers the VPLs that are selected.
    void add(const VplSelection& selection);

    /// Expects the mean of all gathers at each packet to differ by at most `max_errors` of its standard
    /// errors, and a part of 1e-6, from the light of all VPLs.
    void check(double max_errors, CheckResult& result) const;

  private:
    /// The light of each packet: the sum over its receivers and channels.
    std::vector<double> gather(const VplSelection* selection);

    const SelectionCase& data_;
    Gatherer gatherer_;
    GatherSums<Vpl> sums_;
    std::vector<double> full_;
    std::vector<double> deviation_;  ///< sum over the gathers
    std::vector<double> squares_;
    uint count_ = 0;
};

}  // namespace nearlight::core
