// SPDX-License-Identifier: Apache-2.0
// Markov chains over light walks, all in step with each other.
#pragma once

#include "host/cl/kernel.h"
#include "host/stages/compaction.h"
#include "host/stages/device_scene.h"
#include "host/stages/morton_sort.h"
#include "host/stages/pilot_view.h"
#include "host/stages/vpl_contribution.h"

namespace nearlight::core {

/// States of chains, or seeds of them: points of the unit cube and the VPLs they stand for.
struct PathStates {
    PathStates(Device& device, std::size_t state_count, uint bounce_count);

    uint count;
    uint pair_count;        ///< of numbers a state
    Buffer<float> numbers;  ///< in [0, 1), laid out as kernels/metropolis_chains.cl says
    Buffer<Vpl> vpls;       ///< their powers are estimates of all light, each by itself
    Buffer<float> targets;  ///< the density that chains follow, not normalised
};

/// What chains move in and follow. It must not change while they run, nor depend on their seeds.
struct PathSpace {
    const DeviceScene& scene;
    const PilotView& view;
    float clamp_radius = 0.0f;
    float blind_target = 1.0f;  ///< for each watt (luminance) of a VPL, besides what it brings to the camera
    uint seed = 0;
    uint bounce_count = 1;
    Buffer<float> depth_cdf;  ///< bounce_count entries, the last is 1; every depth has a positive probability
};

/// Depths with probabilities in proportion to mean_albedo^depth.
Buffer<float> make_depth_cdf(Device& device, uint bounce_count, float mean_albedo);

class MetropolisChains {
  public:
    /// `vpl_contribution` must outlive it.
    MetropolisChains(Device& device, VplContribution& vpl_contribution);

    /// Independent states, given by their indices (states.count of them) in a randomised sequence.
    void seed(const PathSpace& space, const Buffer<uint>& indices, PathStates& states);
    /// One step of each chain: `proposed` is scratch of the same size. Steps of a run have different numbers.
    void advance(const PathSpace& space, uint step, PathStates& chains, PathStates& proposed);
    /// kept[first + i] = VPL of chain i, its power multiplied by scale / target.
    void keep(const PathStates& chains, float scale, Buffer<Vpl>& kept, std::size_t first);

  private:
    void evaluate(const PathSpace& space, PathStates& states);

    Device* device_;
    VplContribution* vpl_contribution_;
    Program program_;
    Kernel seeds_;
    Kernel walks_;
    Kernel targets_;
    Kernel propose_;
    Kernel accept_;
    Kernel keep_;
    MortonSort morton_sort_;
    Compaction compaction_;
};

}  // namespace nearlight::core
