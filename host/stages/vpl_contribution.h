// SPDX-License-Identifier: Apache-2.0
// Estimates how much each VPL brings to the camera, from a sample of receivers. The coat over a VPL counts,
// except in errors without occlusion. Shading normals of VPLs do not, nor do coats of the receivers for the
// light that arrives, since the estimates only say which VPLs are worth being kept or asked.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/gatherer.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_light.h"

namespace nearlight::core {

/// What VPLs bring to the parts of a picture.
struct GroupContribution {
    std::vector<float> errors;  ///< for each VPL: what it would add to the picture's error if drawn by chance
    /// The R, G and B that each VPL brings to each part: 3 · groups numbers per VPL. The root of the sum of
    /// their squares is the VPL's error, apart from differences within a group.
    std::vector<float> rows;
    /// For each VPL, what unoccluded_errors() would find with the same importons, up to a factor that all
    /// VPLs share.
    std::vector<float> unoccluded;
};

class VplContribution {
  public:
    /// An importon of a group is skipped if its squared importance is below this part of the mean square. The
    /// part is a little less than 1, because otherwise rounding would skip some of several equal importons.
    static constexpr float kNegligiblePart = 0.9f;

    /// Keeps a reference to `gatherer`, which must outlive the object.
    VplContribution(Device& device, Gatherer& gatherer);

    /// Writes one number for each of the first `vpl_count` VPLs: its contribution to the importons of the
    /// view, in the given norm.
    void run(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count, const PilotView& view,
             float clamp_radius, Buffer<float>& contribution, ContributionNorm norm = ContributionNorm::mean);

    /// Returns for each of the first `vpl_count` VPLs about what it would add to the picture's error if
    /// nothing were in the way, by the view's few importons. The unit is another than that of other errors.
    std::vector<float> unoccluded_errors(const Buffer<Vpl>& vpls, std::size_t vpl_count,
                                         const PilotView& view, float clamp_radius);

    /// Estimates contributions by the importons of the view's groups. For each VPL, an importon is skipped if
    /// its squared unoccluded importance is below kNegligiblePart of the mean over all importons.
    GroupContribution by_group(const DeviceScene& scene, const Buffer<Vpl>& vpls, std::size_t vpl_count,
                               const PilotView& view, float clamp_radius);

  private:
    /// Writes, for each receiver, `part` times the mean square of the importance that would arrive from the
    /// importons if nothing were in the way.
    void find_mean_squares(const Buffer<Importon>& importons, std::size_t importon_count,
                           const Buffer<ReceiverPacket>& receivers, std::size_t packet_count,
                           float clamp_radius, float part, Buffer<float>& mean_squares);

    Device* device_;
    Gatherer* gatherer_;
    VplLight vpl_light_;
    Program program_;
    Kernel vpl_contribution_;
    Kernel vpl_group_contribution_;
    Kernel importance_thresholds_;
};

}  // namespace nearlight::core
