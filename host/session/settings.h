// SPDX-License-Identifier: Apache-2.0
// What a user can ask of a render. Empty options are chosen by the renderer (host/session/view.h).
#pragma once

#include <optional>

#include "host/bvh/bvh.h"
#include "host/samplers/sampler.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {

struct RenderSettings {
    SamplerKind sampler = SamplerKind::close_range;
    Policy policy = Policy::complete;
    uint vpl_count = 1000;
    std::optional<float> close_fraction{};  ///< of the budget, [0, 1]
    std::optional<float> range{};           ///< of the close range, m
    std::optional<float> clamp_radius{};    ///< m
    std::optional<uint> max_depth{};  ///< as Mitsuba counts; 1: emission, 2: direct; empty: the scene's, or 8
    std::optional<int> width{};       ///< pixels; empty: the scene's
    std::optional<int> height{};
    uint samples_per_pixel = 4;
    uint direct_samples_per_pixel = 64;  ///< for area and environment lights
    bool indirect_only = false;  ///< leave out direct light (its layer is emission only); for comparisons
    uint seed = 0;
    /// Renderings to average, each with random numbers and VPLs of its own (passes.h); empty: one, or,
    /// where `seconds` is given, as many as fit.
    std::optional<uint> passes{};
    /// No pass but the first is begun that, to judge by those before it, would end so long after the start of
    /// render(); of a renderer's first picture: after the start of its construction.
    std::optional<double> seconds{};
    /// Russian roulette of the gather: VPLs that could bring less than this many times the mean are asked
    /// about by chance (host/stages/roulette.h); 0: all pairs are resolved.
    float roulette = 0.0f;
    GatherKernel gather_kernel = GatherKernel::automatic;
    BvhQuality bvh_quality = BvhQuality::quality;
};

}  // namespace nearlight::core
