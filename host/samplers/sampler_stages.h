// SPDX-License-Identifier: Apache-2.0
// The stages that samplers draw on, compiled once for a device.
#pragma once

#include <optional>

#include "host/stages/bounce_tracer.h"
#include "host/stages/compaction.h"
#include "host/stages/direct_light.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_tracer.h"
#include "host/stages/light_visibility.h"
#include "host/stages/metropolis_chains.h"
#include "host/stages/morton_sort.h"
#include "host/stages/patch_vpls.h"
#include "host/stages/reverse_vpls.h"
#include "host/stages/triangle_classifier.h"
#include "host/stages/vpl_contribution.h"
#include "host/stages/vpl_light.h"
#include "host/stages/vpl_order.h"
#include "host/stages/vpl_placement.h"

namespace nearlight {

struct SamplerStages {
    explicit SamplerStages(Device& on_device, const GatherConfig& gather_config = {})
        : device(on_device),
          gatherer(device, gather_config),
          triangle_classifier(device),
          light_visibility(device),
          compaction(device),
          morton_sort(device),
          vpl_placement(device),
          patch_vpls(device),
          direct_light(device),
          vpl_light(device),
          bounce_tracer(device),
          light_tracer(device),
          vpl_order(device),
          vpl_contribution(device, gatherer),
          reverse_vpls(device, gatherer) {}

    SamplerStages(const SamplerStages&) = delete;  // stages refer to one another
    SamplerStages& operator=(const SamplerStages&) = delete;

    Device& device;
    Gatherer gatherer;
    TriangleClassifier triangle_classifier;
    LightVisibility light_visibility;
    Compaction compaction;
    MortonSort morton_sort;
    VplPlacement vpl_placement;
    PatchVpls patch_vpls;
    DirectLight direct_light;
    VplLight vpl_light;
    BounceTracer bounce_tracer;
    LightTracer light_tracer;
    VplOrder vpl_order;
    VplContribution vpl_contribution;
    ReverseVpls reverse_vpls;

    /// Made when first asked for: one sampler needs it, and its kernels take long to compile.
    MetropolisChains& metropolis_chains() {
        return metropolis_chains_ ? *metropolis_chains_
                                  : metropolis_chains_.emplace(device, vpl_contribution);
    }

  private:
    std::optional<MetropolisChains> metropolis_chains_;
};

}  // namespace nearlight
