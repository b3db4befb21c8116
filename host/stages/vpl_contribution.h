// SPDX-License-Identifier: Apache-2.0
// How much each VPL brings to the camera, over a sample of receivers.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_light.h"

namespace nearlight::core {

/// What VPLs bring to the parts of a picture.
struct GroupContribution {
    std::vector<float> errors;  ///< of each: what it would add to the picture's error if chosen by chance
    /// What each VPL brings to each part, R, G and B: 3 · groups numbers a VPL. The root of the sum of their
    /// squares is the error, but for what differs within a group.
    std::vector<float> rows;
};

class VplContribution {
  public:
    /// Of the mean square; below it an importon of a group is not asked. A little less than 1, or of
    /// importons that are all alike rounding would choose some.
    static constexpr float kNegligiblePart = 0.9f;

    /// Gathers with `gatherer`, which must outlive it.
    VplContribution(Device& device, Gatherer& gatherer);

    /// One number for each of the first `vpl_count` VPLs, over all importons of the view.
    void run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count, const PilotView& view,
             float clamp_radius, Buffer<float>& contribution, ContributionNorm norm = ContributionNorm::mean);

    /// By the importons of the groups. For each VPL those count for nothing whose importance, squared, would
    /// be below kNegligiblePart of the mean of all if nothing were in the way.
    GroupContribution by_group(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                               const PilotView& view, float clamp_radius);

  private:
    Device* device_;
    Gatherer* gatherer_;
    VplLight vpl_light_;
    Program program_;
    Kernel vpl_contribution_;
    Kernel vpl_group_contribution_;
    Kernel importance_thresholds_;
};

}  // namespace nearlight::core
