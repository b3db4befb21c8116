// SPDX-License-Identifier: Apache-2.0
// The stages that samplers use, on one device.
#pragma once

#include <optional>

#include "host/stages/compaction.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_tracer.h"
#include "host/stages/light_visibility.h"
#include "host/stages/metropolis_chains.h"
#include "host/stages/morton_sort.h"
#include "host/stages/patch_vpls.h"
#include "host/stages/receiver_paths.h"
#include "host/stages/reverse_vpls.h"
#include "host/stages/triangle_classifier.h"
#include "host/stages/vpl_contribution.h"
#include "host/stages/vpl_light.h"
#include "host/stages/vpl_order.h"
#include "host/stages/vpl_placement.h"

namespace nearlight::core {

struct SamplerStages {
    explicit SamplerStages(Device& on_device, const GatherConfig& gather_config = {})
        : device(on_device),
          gatherer(device, gather_config),
          triangle_classifier(device),
          compaction(device),
          morton_sort(device),
          vpl_placement(device),
          patch_vpls(device),
          receiver_paths(device),
          vpl_light(device),
          light_tracer(device),
          vpl_order(device),
          vpl_contribution(device, gatherer) {}

    SamplerStages(const SamplerStages&) = delete;  // stages refer to one another
    SamplerStages& operator=(const SamplerStages&) = delete;

    Device& device;
    Gatherer gatherer;
    TriangleClassifier triangle_classifier;
    Compaction compaction;
    MortonSort morton_sort;
    VplPlacement vpl_placement;
    PatchVpls patch_vpls;
    ReceiverPaths receiver_paths;
    VplLight vpl_light;
    LightTracer light_tracer;
    VplOrder vpl_order;
    VplContribution vpl_contribution;

    // These stages are made when they are first needed: few samplers use them, and their kernels take long to
    // compile.

    LightVisibility& light_visibility() { return made(light_visibility_, device); }
    MetropolisChains& metropolis_chains() { return made(metropolis_chains_, device, vpl_contribution); }
    ReverseVpls& reverse_vpls() { return made(reverse_vpls_, device, gatherer); }

  private:
    template <typename Stage, typename... Arguments>
    static Stage& made(std::optional<Stage>& stage, Arguments&... arguments) {
        return stage ? *stage : stage.emplace(arguments...);
    }

    std::optional<LightVisibility> light_visibility_;
    std::optional<MetropolisChains> metropolis_chains_;
    std::optional<ReverseVpls> reverse_vpls_;
};

}  // namespace nearlight::core
